// SPDX-License-Identifier: BSD-3-Clause
//
// Corners, edges and faces of an obstacle with flat faces. A cloth face can rest on a corner, and a cloth edge across
// an edge, with no node anywhere near.
//
//        ___ cloth edge ___            Touchable features are those that cloth can meet first. Of a solid: convex
//             /\                       ones; in a groove (concave edge) the walls on both sides are met before it. Of
//            /  \  convex      \  /    an open shell: every bend, because both sides are free.
//           /    \      concave \/
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "obstacles/box_tree.h"
#include "obstacles/normal_cone.h"
#include "obstacles/triangle_mesh_topology.h"

namespace curtain {

/// How the surface bends at an edge, seen from the side of its normals.
enum class EdgeBend : std::uint8_t {
  kConvex,
  kConcave,
  kFlat,      ///< coplanar within rounding
  kBoundary,  ///< one face: the rim of a shell
  kBranch     ///< three faces or more: only in shells
};

/// "No face."
constexpr std::uint32_t kNoFace = std::numeric_limits<std::uint32_t>::max();

struct ObstacleVertex {
  Vec3 position = Vec3::Zero();  ///< [m]
  Vec3 outward = Vec3::UnitZ();  ///< unit pseudonormal, weighted by the faces' angles
  /// A face of the cloth may rest on it: necessary, not sufficient. Some edge here is touchable; where all are flat or
  /// concave the faces around are met first.
  bool touchable = false;
};

struct ObstacleEdge {
  std::array<Vec3, 2> ends;                                 ///< [m]
  std::array<std::uint32_t, 2> vertices{};                  ///< of `ends`
  std::array<std::uint32_t, 2> faces{kNoFace, kNoFace};     ///< adjacent faces (of a branch: two of them)
  std::array<Vec3, 2> normals{Vec3::Zero(), Vec3::Zero()};  ///< unit, of the faces; zero: it has not just two
  Vec3 outward = Vec3::UnitZ();                             ///< unit mean of the faces' normals; rim: the face's normal
  EdgeBend bend = EdgeBend::kFlat;
  /// An edge of the cloth may touch it. Solid: convex edges. Shell: all but flat ones. A flat edge is never touched
  /// first: the cloth meets the plane of its faces with a node, or at an edge that is not flat.
  bool touchable = false;
};

struct ObstacleTriangle {
  std::array<Vec3, 3> corners;              ///< [m], counter-clockwise from outside
  std::array<std::uint32_t, 3> vertices{};  ///< of `corners`
  Vec3 normal = Vec3::UnitZ();              ///< unit
};

/// Whether edges between coplanar faces are kept: contact ignores them, the wireframe of a mesh shows them.
enum class FlatEdges { kKeep, kDrop };

/// Immutable, so thread-safe. All in the obstacle's frame.
class ObstacleFeatures {
 public:
  /// O(n log n) in the triangles. Corners without a triangle are left out.
  ObstacleFeatures(const MeshTopology& topology, FlatEdges flat_edges);

  /// A solid with an inside (watertight), or a shell with two free sides.
  bool closed() const { return closed_; }
  const std::vector<ObstacleVertex>& vertices() const { return vertices_; }
  const std::vector<ObstacleEdge>& edges() const { return edges_; }
  const std::vector<ObstacleTriangle>& triangles() const { return triangles_; }

  /// Call f(index, feature) once for every feature whose box overlaps `box` (limits included), touchable or not, in an
  /// order that depends on the obstacle only. `box` in the obstacle's frame [m]; empty or NaN: none. Allocate nothing.
  template <typename F>
  void forEachVertexIn(const Eigen::AlignedBox3d& box, F&& f) const {
    visit(vertex_tree_, vertices_, box, f);
  }
  template <typename F>
  void forEachEdgeIn(const Eigen::AlignedBox3d& box, F&& f) const {
    visit(edge_tree_, edges_, box, f);
  }
  template <typename F>
  void forEachTriangleIn(const Eigen::AlignedBox3d& box, F&& f) const {
    visit(triangle_tree_, triangles_, box, f);
  }
  /// The same without those in boxes to whose cone of the faces' normals wanted(cone) says no.
  template <typename Wanted, typename F>
  void forEachVertexIn(const Eigen::AlignedBox3d& box, const Wanted& wanted, F&& f) const {
    visit(vertex_tree_, vertices_, vertex_cones_, box, wanted, f);
  }
  template <typename Wanted, typename F>
  void forEachEdgeIn(const Eigen::AlignedBox3d& box, const Wanted& wanted, F&& f) const {
    visit(edge_tree_, edges_, edge_cones_, box, wanted, f);
  }
  /// Whether f(unit direction) is true of an edge that leaves the vertex. Those between coplanar faces may be missing.
  template <typename F>
  bool anyEdgeOf(std::uint32_t vertex, F&& f) const {
    for (std::uint32_t k = first_edge_[vertex]; k < first_edge_[vertex + 1]; ++k) {
      if (f(edge_directions_[k])) return true;
    }
    return false;
  }
  /// The same for one feature.
  template <typename F>
  void ifVertexIn(const Eigen::AlignedBox3d& box, std::uint32_t n, F&& f) const {
    if (touches(vertices_[n], box)) f(n, vertices_[n]);
  }
  template <typename F>
  void ifEdgeIn(const Eigen::AlignedBox3d& box, std::uint32_t n, F&& f) const {
    if (touches(edges_[n], box)) f(n, edges_[n]);
  }

 private:
  static Vec3 low(const ObstacleVertex& v) { return v.position; }
  static Vec3 high(const ObstacleVertex& v) { return v.position; }
  static Vec3 low(const ObstacleEdge& e) { return e.ends[0].cwiseMin(e.ends[1]); }
  static Vec3 high(const ObstacleEdge& e) { return e.ends[0].cwiseMax(e.ends[1]); }
  static Vec3 low(const ObstacleTriangle& t) { return t.corners[0].cwiseMin(t.corners[1]).cwiseMin(t.corners[2]); }
  static Vec3 high(const ObstacleTriangle& t) { return t.corners[0].cwiseMax(t.corners[1]).cwiseMax(t.corners[2]); }

  template <typename Feature>
  static bool touches(const Feature& feature, const Eigen::AlignedBox3d& box) {
    return (low(feature).array() <= box.max().array()).all() && (high(feature).array() >= box.min().array()).all();
  }
  template <typename Feature, typename F>
  static void visit(const BoxTree& tree, const std::vector<Feature>& features, const Eigen::AlignedBox3d& box, F& f) {
    tree.forEachRunIn(box, [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t n = first; n < last; ++n) {
        if (touches(features[n], box)) f(n, features[n]);
      }
    });
  }

  template <typename Feature, typename Wanted, typename F>
  static void visit(const BoxTree& tree, const std::vector<Feature>& features, const std::vector<NormalCone>& cones,
                    const Eigen::AlignedBox3d& box, const Wanted& wanted, F& f) {
    const auto enters = [&](std::uint32_t node, const Vec3& low, const Vec3& high) {
      return (low.array() <= box.max().array()).all() && (high.array() >= box.min().array()).all() &&
             wanted(cones[node]);
    };
    tree.forEachLeafOf(enters, [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t n = first; n < last; ++n) {
        if (touches(features[n], box)) f(n, features[n]);
      }
    });
  }

  /// Builds the tree over the features and sorts them by its leaves; returns the new index of each.
  template <typename Feature>
  static std::vector<std::uint32_t> plant(std::vector<Feature>& features, BoxTree& tree);
  void addVertices(const MeshTopology& topology);
  void addTriangles(const MeshTopology& topology);
  void addEdges(const MeshTopology& topology, FlatEdges flat_edges);
  void addDirections();
  void addCones();

  bool closed_ = false;
  std::vector<ObstacleVertex> vertices_;
  std::vector<ObstacleEdge> edges_;
  std::vector<ObstacleTriangle> triangles_;
  std::vector<std::uint32_t> first_edge_;              // by vertex: in edge_directions_
  std::vector<Vec3> edge_directions_;                  // unit
  std::vector<NormalCone> vertex_cones_, edge_cones_;  // by node of their trees
  std::vector<std::uint32_t> vertex_of_corner_;        // while building: corner of the mesh -> index in vertices_
  std::vector<std::uint32_t> face_of_triangle_;        // while building: triangle of the mesh -> index in triangles_
  BoxTree vertex_tree_;
  BoxTree edge_tree_;
  BoxTree triangle_tree_;
};

}  // namespace curtain
