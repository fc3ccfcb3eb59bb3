// SPDX-License-Identifier: BSD-3-Clause
#include "contact/oracle/piercings.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "cloth/coarse_mesh.h"
#include "obstacles/convex_shape.h"
#include "obstacles/obstacle_features.h"

namespace curtain {
namespace {

using Triangle = std::array<Vec3, 3>;
using Edge = std::array<Vec3, 2>;

/// Points sampled between two crossings of a surface, where an edge may be inside a solid.
constexpr int kProbes = 16;

/// A face and the indices of its edges.
struct Face {
  Triangle corners;
  std::array<std::size_t, 3> edges;
};

/// The cloth in the obstacle's frame.
struct ClothMesh {
  std::vector<Vec3> nodes;
  std::vector<Edge> edges;
  std::vector<Face> faces;
};

/// point(n) is where node n is, in the obstacle's frame.
template <typename Point>
ClothMesh makeMesh(const std::vector<MeshTriangle>& triangles, const Point& point) {
  std::vector<std::uint32_t> nodes;
  std::vector<MeshEdge> edges;
  const auto side = [](const MeshTriangle& triangle, std::size_t k) {
    const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
    return MeshEdge{low, high};
  };
  const auto makeUnique = [](auto& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  for (const MeshTriangle& triangle : triangles) {
    nodes.insert(nodes.end(), triangle.begin(), triangle.end());
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(side(triangle, k));
  }
  makeUnique(nodes);
  makeUnique(edges);
  ClothMesh mesh;
  for (const std::uint32_t node : nodes) mesh.nodes.push_back(point(node));
  for (const MeshEdge& edge : edges) mesh.edges.push_back({point(edge[0]), point(edge[1])});
  for (const MeshTriangle& triangle : triangles) {
    Face face;
    for (std::size_t k = 0; k < 3; ++k) {
      face.corners[k] = point(triangle[k]);
      const auto found = std::lower_bound(edges.begin(), edges.end(), side(triangle, k));
      face.edges[k] = static_cast<std::size_t>(found - edges.begin());
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

template <std::size_t N>
Eigen::AlignedBox3d boxOf(const std::array<Vec3, N>& corners) {
  Eigen::AlignedBox3d box;
  for (const Vec3& corner : corners) box.extend(corner);
  return box;
}

/// Fraction at which the segment p-q crosses the triangle with both ends further than `tolerance` [m] from its plane,
/// on different sides. A segment through an edge shared by two triangles crosses at least one of them: their volumes
/// are exact negatives of each other.
std::optional<double> crossing(const Edge& segment, const Triangle& triangle, double tolerance) {
  const auto& [p, q] = segment;
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double area = normal.norm();
  if (!(area > 0.0)) return std::nullopt;
  const double height_p = normal.dot(p - triangle[0]) / area;
  const double height_q = normal.dot(q - triangle[0]) / area;
  const bool through =
      (height_p > tolerance && height_q < -tolerance) || (height_p < -tolerance && height_q > tolerance);
  if (!through) return std::nullopt;
  bool none_left = true;
  bool none_right = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const double volume = (q - p).dot((triangle[k] - p).cross(triangle[(k + 1) % 3] - p));
    none_left = none_left && volume <= 0.0;
    none_right = none_right && volume >= 0.0;
  }
  if (!none_left && !none_right) return std::nullopt;
  return height_p / (height_p - height_q);
}

bool isDeep(const ContactShape& shape, const Vec3& point, double tolerance) {
  SurfacePoint surface;
  return shape.query(point, point, 0.0, surface) && surface.distance < -tolerance;
}

/// Whether an edge gets deep into a solid mesh: it can be inside between crossings only.
bool dipsInto(const ContactShape& solid, const ObstacleFeatures& features, const Edge& edge, double tolerance) {
  std::vector<double> fractions{0.0, 1.0};
  const Eigen::AlignedBox3d box = boxOf(edge);
  for (const ObstacleTriangle& triangle : features.triangles()) {
    if (!box.intersects(boxOf(triangle.corners))) continue;
    if (const auto fraction = crossing(edge, triangle.corners, 0.0)) fractions.push_back(*fraction);
  }
  std::sort(fractions.begin(), fractions.end());
  for (std::size_t n = 1; n < fractions.size(); ++n) {
    for (int probe = 0; probe <= kProbes; ++probe) {
      const double t = fractions[n - 1] + (fractions[n] - fractions[n - 1]) * probe / kProbes;
      if (isDeep(solid, edge[0] + t * (edge[1] - edge[0]), tolerance)) return true;
    }
  }
  return false;
}

bool crossesShell(const ObstacleFeatures& features, const Edge& edge, double tolerance) {
  const Eigen::AlignedBox3d box = boxOf(edge);
  return std::any_of(features.triangles().begin(), features.triangles().end(), [&](const ObstacleTriangle& triangle) {
    return box.intersects(boxOf(triangle.corners)) && crossing(edge, triangle.corners, tolerance);
  });
}

bool isPierced(const ObstacleFeatures& features, const Triangle& face, double tolerance) {
  const Eigen::AlignedBox3d box = boxOf(face);
  return std::any_of(features.edges().begin(), features.edges().end(), [&](const ObstacleEdge& edge) {
    return box.intersects(boxOf(edge.ends)) && crossing(edge.ends, face, tolerance);
  });
}

Piercings countInConvex(const ConvexShape& shape, const ClothMesh& mesh, double tolerance) {
  Piercings count;
  ElementPoint deepest;
  for (const Vec3& node : mesh.nodes) count.nodes += shape.nearest(node).distance < -tolerance;
  for (const Edge& edge : mesh.edges) {
    count.edges += shape.nearestOnEdge(edge, -tolerance, deepest) && deepest.surface.distance < -tolerance;
  }
  for (const Face& face : mesh.faces) {
    count.faces += shape.nearestOnTriangle(face.corners, -tolerance, deepest) && deepest.surface.distance < -tolerance;
  }
  return count;
}

Piercings countInMesh(const ContactShape& shape, const ObstacleFeatures& features, const ClothMesh& mesh,
                      double tolerance) {
  Piercings count;
  const bool closed = features.closed();
  const Eigen::AlignedBox3d bounds = shape.bounds();
  for (const Vec3& node : mesh.nodes) count.nodes += closed && isDeep(shape, node, tolerance);
  std::vector<bool> counts;
  for (const Edge& edge : mesh.edges) {
    counts.push_back(bounds.intersects(boxOf(edge)) &&
                     (closed ? dipsInto(shape, features, edge, tolerance) : crossesShell(features, edge, tolerance)));
    count.edges += counts.back();
  }
  for (const Face& face : mesh.faces) {
    const bool by_edge = counts[face.edges[0]] || counts[face.edges[1]] || counts[face.edges[2]];
    count.faces += by_edge || (bounds.intersects(boxOf(face.corners)) && isPierced(features, face.corners, tolerance));
  }
  return count;
}

Piercings judge(const ContactShape& shape, const ClothMesh& mesh, double tolerance) {
  if (shape.convex() != nullptr) return countInConvex(*shape.convex(), mesh, tolerance);
  return shape.features() == nullptr ? Piercings() : countInMesh(shape, *shape.features(), mesh, tolerance);
}

}  // namespace

Piercings countPiercings(const ContactShape& shape, const Transform& place, const Grid& grid, const Field3& position,
                         double depth_tolerance) {
  const auto point = [&](std::uint32_t node) { return place.toLocal(position.at(node)); };
  return judge(shape, makeMesh(makeCoarseMesh(grid).triangles, point), depth_tolerance);
}

Piercings countPiercings(const ContactShape& shape, const Transform& place, const std::vector<Vec3>& points,
                         const std::vector<MeshTriangle>& triangles, double depth_tolerance) {
  const auto point = [&](std::uint32_t node) { return place.toLocal(points[node]); };
  return judge(shape, makeMesh(triangles, point), depth_tolerance);
}

}  // namespace curtain
