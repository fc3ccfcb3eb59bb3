// SPDX-License-Identifier: BSD-3-Clause
//
// Broad phase against one obstacle: what may touch it in one substep, in the obstacle's frame, where it is at rest.
//
//                           nodes    those that may come within nodeReach()
//  start ------------> end  faces    triangles that may come within a reach (convex shapes)
//     ( obstacle )          pairs    cloth edge x obstacle edge, cloth triangle x obstacle corner (meshes)
//
// Candidates are computed for every motion. What is kept from substep to substep are facts about the obstacle, which
// hold wherever the cloth is: of a convex shape a tangent plane for each face, of a mesh the triangles near each node
// and the windows of mesh_clearance.h. Each is there because it was measured to pay (docs/method.md, Contact).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"
#include "cloth/coarse_mesh.h"
#include "cloth/workers.h"
#include "contact/broad_phase/mesh_clearance.h"
#include "contact/narrow_phase/element_pairs.h"
#include "obstacles/obstacle_set.h"
#include "obstacles/triangle_mesh.h"
#include "scene/infinity.h"

namespace curtain {

/// Box around the cloth, at both instants [m].
Eigen::AlignedBox3d boxAround(const Grid& grid, const Field3& start, const Field3& end) noexcept;

/// A cloth edge (2 nodes) and an obstacle edge, or a cloth triangle (3 nodes) and an obstacle corner.
struct FeaturePair {
  std::array<std::uint32_t, 3> node{};
  std::uint32_t feature = 0;  ///< index of the edge or the corner in the obstacle's features
  bool edges = false;
};

/// Surface point of the obstacle, found from a position of the cloth; at first none, which proves nothing.
struct SeenSurface {
  Vec3 at = Vec3::Zero();                          ///< position it was found from [m]
  SurfacePoint surface{-kInfinity, Vec3::Zero()};  ///< without a normal, `distance` is a lower bound

  /// Lower bound of the distance from p to the surface, by the triangle inequality [m]; p outside.
  double lowerBound(const Vec3& p) const noexcept { return surface.distance - (p - at).norm(); }
  /// Proof that neither end of the motion is within reach, and that it meets nothing in between.
  bool isClearOf(const Vec3& from, const Vec3& to, double reach) const noexcept {
    const double first = lowerBound(from), last = lowerBound(to);
    return first > 0.0 && last > reach && first + last > (to - from).norm();
  }
  /// Height above the tangent plane [m]; for a convex shape a lower bound of the distance.
  double height(const Vec3& p) const noexcept { return surface.distance + surface.normal.dot(p - at); }
};

/// What the cloth keeps from one obstacle.
struct ObstacleGaps {
  double thickness;      ///< of nodes, from the padding [m]
  double core;           ///< of faces, from the padding [m]
  double padding = 0.0;  ///< from the surface [m]
};

class ObstacleCandidates {
 public:
  /// A triangle of the cloth and its index.
  struct Face {
    MeshTriangle node;
    std::uint32_t index;
  };

  /// pattern, shape and workers must outlive this. Allocates everything here.
  ObstacleCandidates(const ClothPattern& pattern, const ContactShape& shape, const ObstacleGaps& gaps,
                     const Workers& workers);

  /// Starts a substep: finds candidates of the motion from start to predicted.
  void prepare(const MovingObstacle& moving, const Field3& start, const Field3& predicted) noexcept;
  /// Finds candidates of another motion from the same start, for continuous detection.
  void follow(const MovingObstacle& moving, const Field3& end) noexcept;
  void invalidate() noexcept;

  const std::vector<std::uint32_t>& nodes() const noexcept { return nodes_; }
  const std::vector<Face>& faces() const noexcept { return faces_; }
  const std::vector<FeaturePair>& pairs() const noexcept { return pairs_; }

  /// Of a candidate's node, in the obstacle's frame [m].
  Vec3 startOf(std::size_t node) const noexcept { return start_.at(node); }
  Vec3 endOf(std::size_t node) const noexcept { return end_.at(node); }
  /// Surface at the end of a node's motion, or where the node went through it.
  struct NodeEnd {
    std::uint32_t node;
    SurfacePoint surface;
  };
  /// Movable candidate nodes that end within reach [m] or went through the surface. Valid until the next call.
  std::vector<NodeEnd>& queryEnds(double reach) noexcept;
  /// Surface nearest to a node that has come here from its start; false: further than nodeReach().
  bool surfaceOf(std::size_t node, const Vec3& position, SurfacePoint& out) noexcept {
    return query(node, start_.at(node), position, nodeReach(), out);
  }
  /// What a candidate's node saw last in this substep: at its start or at its predicted end.
  SeenSurface& seen(std::size_t node) noexcept { return seen_[node]; }
  const SeenSurface& seen(std::size_t node) const noexcept { return seen_[node]; }

  /// Tangent plane at a face's nearest point, when that was last computed.
  SeenSurface& facePlane(const Face& face) noexcept { return face_planes_[face.index]; }

  /// Signed distance at the start of the substep, cut at what nodes keep [m].
  double distanceOf(std::size_t node) const noexcept {
    return queried_at_[node] == substep_ ? std::min(distance_[node], thickness()) : thickness();
  }
  /// The same, not cut; a lower bound where the surface is far [m].
  double farOf(std::size_t node) const noexcept {
    return queried_at_[node] == substep_ ? distance_[node] : thickness();
  }
  /// The node starts inside the obstacle. What has such a node is coming out and must not be stopped.
  bool isInside(std::size_t node) const noexcept { return distanceOf(node) < 0.0 && !isPinned(node); }
  bool isPinned(std::size_t node) const noexcept { return pattern_.inverse_mass[node] <= 0.0; }

  const ContactShape& shape() const noexcept { return shape_; }
  /// Distance from the surface that nodes and faces keep [m].
  double thickness() const noexcept { return gaps_.thickness + gaps_.padding; }
  double core() const noexcept { return gaps_.core + gaps_.padding; }
  /// Nodes and elements that come nearer than this are candidates, for certain [m].
  double nodeReach() const noexcept { return 1.5 * gaps_.thickness + gaps_.padding; }
  double elementReach() const noexcept { return 0.4 * gaps_.thickness + gaps_.padding; }
  /// The same for crossings: twice what counts as crossing, because times of impact may be early [m].
  double crossingReach() const noexcept { return 2.0 * kMinShare * gaps_.thickness + gaps_.padding; }
  /// Distance below which a part counts as crossing [m]; at most, and for one that starts at `distance` > 0: one that
  /// is within the padding already may not go half of the way to the surface.
  double least() const noexcept { return gaps_.padding + kMinShare * gaps_.thickness; }
  double least(double distance) const noexcept {
    const double above = distance - gaps_.padding;
    return above > 0.0 ? gaps_.padding + std::min(kMinShare * gaps_.thickness, 0.5 * above) : 0.5 * distance;
  }
  /// A list ran full: candidates are missing.
  bool full() const noexcept { return full_; }

 private:
  // What counts as crossing, over the thickness.
  static constexpr double kMinShare = 0.02;

  static void toLocal(const Transform& place, const Field3& position, Field3& out) noexcept;
  void list(const MovingObstacle& moving, const Field3& end, double reach) noexcept;
  bool query(std::size_t node, const Vec3& previous, const Vec3& current, double reach, SurfacePoint& out) noexcept {
    if (mesh_ == nullptr) return shape_.query(previous, current, reach, out);
    return mesh_->query(previous, current, reach, gaps_.thickness, triangles_[node], out);
  }
  void listNodes() noexcept;
  bool isNear(std::size_t node, const Eigen::AlignedBox3d& box) noexcept;
  void queryStart(std::size_t node) noexcept;
  Eigen::AlignedBox3d boundsWithin(double around) const noexcept;
  Eigen::AlignedBox3d boxOf(const std::array<std::uint32_t, 4>& corners) const noexcept;
  Eigen::AlignedBox3d boxOfRows(int i) const noexcept {
    return row_boxes_[static_cast<std::size_t>(i)].merged(row_boxes_[static_cast<std::size_t>(i) + 1]);
  }
  void listFaces(double reach) noexcept;
  bool staysAbove(const Face& face, double reach) noexcept;
  /// Pairs found by one worker.
  struct Pairs {
    std::vector<FeaturePair> list;
    bool full = false;
    void add(const FeaturePair& pair) noexcept { full = !addWithinRoom(pair, list) || full; }
  };
  void listPairs(double reach) noexcept;
  void listPairsOfRow(int row, const Eigen::AlignedBox3d& box, double reach, Pairs& out) noexcept;
  void listPairsOf(const QuadElements& quad, const SweptQuad& swept, double reach, Pairs& out) const noexcept;
  void addEdgePair(const MeshEdge& edge, std::uint32_t index, double reach, Pairs& out) const noexcept;
  void addCornerPair(const MeshTriangle& triangle, std::uint32_t index, double reach, Pairs& out) const noexcept;

  const ClothPattern& pattern_;
  const ContactShape& shape_;
  const Workers& workers_;
  const TriangleMeshShape* mesh_;
  ObstacleGaps gaps_;
  bool elements_wanted_;
  Field3 start_, end_;             // of this substep [m]
  std::vector<SeenSurface> seen_;  // by node; of the substep in queried_at_
  std::vector<double>
      distance_;  // by node: at the start of the substep in queried_at_; a lower bound when the surface was far [m]
  std::uint32_t substep_ = 0;
  std::vector<std::uint32_t> queried_at_;       // by node: substep at whose start distance_ was computed
  std::vector<Eigen::AlignedBox3d> row_boxes_;  // around the motion of a row [m]
  bool full_ = false;
  std::vector<std::uint32_t> nodes_;  // candidates, pinned ones included
  std::vector<std::uint8_t> near_;    // by node: it is in nodes_
  std::vector<NodeEnd> ends_;
  std::vector<std::uint8_t> found_;  // by index in nodes_: its end is in ends_
  std::vector<Face> faces_;
  std::vector<SeenSurface> face_planes_;  // by face index, of a convex shape
  std::vector<NearTriangles> triangles_;  // by node, of a mesh
  MeshClearance mesh_clearance_;          // of a mesh
  std::vector<FeaturePair> pairs_;
  std::vector<Pairs> shares_;  // of pairs_
};

}  // namespace curtain
