// SPDX-License-Identifier: BSD-3-Clause
#include "obstacles/obstacle_features.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace curtain {
namespace {

/// Angle between faces that count as coplanar [rad]: 1 um over an edge of 1 m.
constexpr double kFlatAngle = 1e-6;

/// Rotation of the triangle's normal by rounding of the corners [rad].
double normalError(const ObstacleTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const double height = (b - a).cross(c - a).norm() / longest;
  const double largest = std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
  return 8.0 * std::numeric_limits<double>::epsilon() * largest / height;
}

/// Bend between two faces with normals on the same side; `along`: unit, in the direction of the first face's edge.
EdgeBend bendOf(const Vec3& normal, const Vec3& across, const Vec3& along, double flat_angle) {
  const double sine = normal.cross(across).dot(along);
  const double cosine = normal.dot(across);
  if (cosine > 0.0 && std::abs(sine) <= flat_angle) return EdgeBend::kFlat;
  // A knife edge bends by half a turn: rounding must not make it concave.
  return sine >= -flat_angle ? EdgeBend::kConvex : EdgeBend::kConcave;
}

}  // namespace

template <typename Feature>
std::vector<std::uint32_t> ObstacleFeatures::plant(std::vector<Feature>& features, BoxTree& tree) {
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(features.size());
  for (const Feature& feature : features) boxes.emplace_back(low(feature), high(feature));
  tree = BoxTree(boxes);
  std::vector<Feature> sorted;
  sorted.reserve(features.size());
  std::vector<std::uint32_t> place(features.size());
  for (const std::uint32_t item : tree.order()) {
    place[item] = static_cast<std::uint32_t>(sorted.size());
    sorted.push_back(features[item]);
  }
  features = std::move(sorted);
  return place;
}

ObstacleFeatures::ObstacleFeatures(const MeshTopology& topology, FlatEdges flat_edges) : closed_(topology.watertight) {
  addVertices(topology);
  addTriangles(topology);
  addEdges(topology, flat_edges);
  addDirections();
  addCones();
  vertex_of_corner_ = {};
  face_of_triangle_ = {};
}

void ObstacleFeatures::addVertices(const MeshTopology& topology) {
  const ShapeTriangles& mesh = topology.mesh;
  constexpr std::uint32_t kUnused = kNoFace;
  vertex_of_corner_.assign(mesh.corners.size(), kUnused);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const auto corner = static_cast<std::size_t>(mesh.triangles[t][i]);
      if (vertex_of_corner_[corner] != kUnused) continue;
      vertex_of_corner_[corner] = static_cast<std::uint32_t>(vertices_.size());
      const Vec3& normal = topology.corner_normals[corner];  // zero: the normals around cancel
      vertices_.push_back({mesh.corners[corner], normal == Vec3::Zero() ? topology.face_normals[t] : normal, false});
    }
  }
  const std::vector<std::uint32_t> place = plant(vertices_, vertex_tree_);
  for (std::uint32_t& vertex : vertex_of_corner_) {
    if (vertex != kUnused) vertex = place[vertex];
  }
}

void ObstacleFeatures::addTriangles(const MeshTopology& topology) {
  const ShapeTriangles& mesh = topology.mesh;
  triangles_.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    ObstacleTriangle triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto corner = static_cast<std::size_t>(mesh.triangles[t][static_cast<int>(i)]);
      triangle.corners[i] = mesh.corners[corner];
      triangle.vertices[i] = vertex_of_corner_[corner];
    }
    triangle.normal = topology.face_normals[t];
    triangles_.push_back(triangle);
  }
  face_of_triangle_ = plant(triangles_, triangle_tree_);
}

void ObstacleFeatures::addEdges(const MeshTopology& topology, FlatEdges flat_edges) {
  const std::vector<MeshSide> sides = sortedSides(topology.mesh);
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t next = first + 1;
    while (next < sides.size() && sides[next].sameEdge(sides[first])) ++next;
    const MeshSide& side = sides[first];
    const std::size_t count = next - first;
    ObstacleEdge edge;
    const auto from = static_cast<std::size_t>(side.forward ? side.low : side.high);
    const auto to = static_cast<std::size_t>(side.forward ? side.high : side.low);
    edge.ends = {topology.mesh.corners[from], topology.mesh.corners[to]};
    edge.vertices = {vertex_of_corner_[from], vertex_of_corner_[to]};
    edge.faces[0] = face_of_triangle_[side.triangle];
    const Vec3& normal = topology.face_normals[side.triangle];
    Vec3 across = normal;
    double flat_angle = kFlatAngle + normalError(triangles_[edge.faces[0]]);
    if (count >= 2) {
      edge.faces[1] = face_of_triangle_[sides[first + 1].triangle];
      // Faces of a shell may be wound oppositely: then the second normal is flipped.
      const bool agree = sides[first + 1].forward != side.forward;
      across =
          agree ? topology.face_normals[sides[first + 1].triangle] : -topology.face_normals[sides[first + 1].triangle];
      flat_angle += normalError(triangles_[edge.faces[1]]);
      if (count == 2) edge.normals = {normal, across};
    } else if (closed_) {
      // The neighbour was degenerate and is dropped. The pseudonormal is half way to the normal of the face behind it.
      const Vec3& half_way = topology.edge_normals[side.triangle][side.slot];
      across = 2.0 * half_way.dot(normal) * half_way - normal;
    }
    edge.outward = unitOrFallback(normal + across, normal);
    if (count > 2) {
      edge.bend = EdgeBend::kBranch;
    } else if (count == 1 && !closed_) {
      edge.bend = EdgeBend::kBoundary;
    } else {
      edge.bend = bendOf(normal, across, (edge.ends[1] - edge.ends[0]).normalized(), flat_angle);
    }
    edge.touchable = edge.bend != EdgeBend::kFlat && !(closed_ && edge.bend == EdgeBend::kConcave);
    if (edge.touchable)
      for (const std::uint32_t vertex : edge.vertices) vertices_[vertex].touchable = true;
    if (edge.bend != EdgeBend::kFlat || flat_edges == FlatEdges::kKeep) edges_.push_back(edge);
    first = next;
  }
  plant(edges_, edge_tree_);
}

// Of a rim or a branch any direction counts.
void ObstacleFeatures::addCones() {
  std::vector<NormalCone> of_vertices(vertices_.size());
  for (std::size_t n = 0; n < vertices_.size(); ++n) of_vertices[n] = {vertices_[n].outward, 0.0};
  std::vector<NormalCone> of_edges;
  of_edges.reserve(edges_.size());
  for (const ObstacleEdge& edge : edges_) {
    NormalCone& cone = of_edges.emplace_back(NormalCone{edge.outward, 0.0});
    for (const Vec3& normal : edge.normals) {
      cone.hold(normal);
      for (const std::uint32_t vertex : edge.vertices) of_vertices[vertex].hold(normal);
    }
  }
  const auto gather = [](const BoxTree& tree, const std::vector<NormalCone>& of, std::vector<NormalCone>& cones) {
    cones.resize(tree.nodeCount());
    tree.forEachNodeUp(
        [&](std::size_t node, std::uint32_t first, std::uint32_t last) {
          cones[node] = of[first];
          for (std::uint32_t n = first + 1; n < last; ++n) cones[node] = around(cones[node], of[n]);
        },
        [&](std::size_t node, std::uint32_t child, std::uint32_t other) {
          cones[node] = around(cones[child], cones[other]);
        });
  };
  gather(vertex_tree_, of_vertices, vertex_cones_);
  gather(edge_tree_, of_edges, edge_cones_);
}

void ObstacleFeatures::addDirections() {
  first_edge_.assign(vertices_.size() + 1, 0);
  for (const ObstacleEdge& edge : edges_) {
    for (const std::uint32_t vertex : edge.vertices) ++first_edge_[vertex + 1];
  }
  std::partial_sum(first_edge_.begin(), first_edge_.end(), first_edge_.begin());
  edge_directions_.resize(2 * edges_.size());
  std::vector<std::uint32_t> next(first_edge_.begin(), first_edge_.end() - 1);
  for (const ObstacleEdge& edge : edges_) {
    const Vec3 along = (edge.ends[1] - edge.ends[0]).normalized();
    edge_directions_[next[edge.vertices[0]]++] = along;
    edge_directions_[next[edge.vertices[1]]++] = -along;
  }
}

}  // namespace curtain
