// SPDX-License-Identifier: BSD-3-Clause
#include "contact/oracle/obstacle_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "cloth/coarse_mesh.h"
#include "contact/narrow_phase/closest_points.h"
#include "obstacles/convex_shape.h"
#include "obstacles/obstacle_features.h"

namespace curtain {
namespace {

/// The search, in the obstacle's frame. First the nodes: how near they are bounds how near their quads can be.
class Search {
 public:
  Search(const ContactShape& shape, const Transform& place, const Grid& grid, const Field3& position)
      : shape_(shape), grid_(grid), local_(grid.size()), at_least_(grid.size(), 0.0) {
    forEachNode([&](std::size_t n) { local_[n] = place.toLocal(position.at(n)); });
  }

  ObstacleDistance run() {
    const double quad = largestQuad();
    forEachNode([&](std::size_t n) {
      SurfacePoint surface;
      // A node that is further away than this has no quad that is nearer than what is found already.
      const double reach = std::max(0.0, found_.distance) + quad;
      at_least_[n] = reach;
      if (!shape_.query(local_[n], local_[n], reach, surface)) return;
      at_least_[n] = surface.distance;
      offer(surface.distance, local_[n], local_[n] - surface.distance * surface.normal);
    });
    forEachQuad([&](const QuadElements& q) {
      if (at_least_[q.corners[0]] - quad < found_.distance) measure(q);
    });
    return found_;
  }

 private:
  template <typename Visit>
  void forEachNode(const Visit& visit) const {
    for (int i = 0; i < grid_.rows; ++i) {
      for (int j = 0; j < grid_.columns; ++j) visit(grid_.index(i, j));
    }
  }
  template <typename Visit>
  void forEachQuad(const Visit& visit) const {
    for (int i = 0; i + 1 < grid_.rows; ++i) {
      for (int j = 0; j < grid_.linkCount(); ++j) visit(quadElements(grid_, i, j));
    }
  }

  /// Furthest that a corner of a quad is from its first one [m].
  double largestQuad() const {
    double largest = 0.0;
    forEachQuad([&](const QuadElements& q) {
      for (const std::uint32_t node : q.corners)
        largest = std::max(largest, (local_[node] - local_[q.corners[0]]).norm());
    });
    return largest;
  }

  void offer(double distance, const Vec3& on_cloth, const Vec3& on_obstacle) {
    if (distance < found_.distance) found_ = {distance, on_cloth, on_obstacle};
  }

  void measure(const QuadElements& q) {
    for (int t = 0; t < q.triangle_count; ++t) {
      const MeshTriangle& triangle = q.triangles[static_cast<std::size_t>(t)];
      const std::array<Vec3, 3> corners{local_[triangle[0]], local_[triangle[1]], local_[triangle[2]]};
      if (shape_.convex() != nullptr)
        measureConvex(corners);
      else if (shape_.features() != nullptr)
        measureVertices(corners);
    }
    for (int e = 0; e < q.edge_count; ++e) {
      const MeshEdge& edge = q.edges[static_cast<std::size_t>(e)];
      const std::array<Vec3, 2> ends{local_[edge[0]], local_[edge[1]]};
      if (shape_.convex() != nullptr)
        measureConvex(ends);
      else if (shape_.features() != nullptr)
        measureEdges(ends);
    }
  }

  void measureConvex(const std::array<Vec3, 3>& corners) {
    ElementPoint point;
    if (shape_.convex()->nearestOnTriangle(corners, found_.distance, point))
      offerPoint(point, point.weights[0] * corners[0] + point.weights[1] * corners[1] + point.weights[2] * corners[2]);
  }
  void measureConvex(const std::array<Vec3, 2>& ends) {
    ElementPoint point;
    if (shape_.convex()->nearestOnEdge(ends, found_.distance, point))
      offerPoint(point, point.weights[0] * ends[0] + point.weights[1] * ends[1]);
  }
  void offerPoint(const ElementPoint& point, const Vec3& on_cloth) {
    offer(point.surface.distance, on_cloth, on_cloth - point.surface.distance * point.surface.normal);
  }

  template <std::size_t N>
  Eigen::AlignedBox3d around(const std::array<Vec3, N>& corners) const {
    Eigen::AlignedBox3d box;
    for (const Vec3& corner : corners) box.extend(corner);
    const Vec3 reach = Vec3::Constant(std::max(0.0, found_.distance));
    return {box.min() - reach, box.max() + reach};
  }
  void measureVertices(const std::array<Vec3, 3>& c) {
    shape_.features()->forEachVertexIn(around(c), [&](std::uint32_t, const ObstacleVertex& vertex) {
      const TriangleClosest closest = closestOnTriangle(vertex.position, c[0], c[1], c[2]);
      const Vec3& w = closest.weights;
      offer(std::sqrt(closest.distance_squared), w[0] * c[0] + w[1] * c[1] + w[2] * c[2], vertex.position);
    });
  }
  void measureEdges(const std::array<Vec3, 2>& ends) {
    shape_.features()->forEachEdgeIn(around(ends), [&](std::uint32_t, const ObstacleEdge& edge) {
      const SegmentsClosest closest = closestOnSegments(ends[0], ends[1], edge.ends[0], edge.ends[1]);
      offer(std::sqrt(closest.distance_squared), ends[0] + closest.s * (ends[1] - ends[0]),
            edge.ends[0] + closest.t * (edge.ends[1] - edge.ends[0]));
    });
  }

  const ContactShape& shape_;
  const Grid& grid_;
  std::vector<Vec3> local_;
  std::vector<double> at_least_;  // distance of the nodes [m]
  ObstacleDistance found_;
};

}  // namespace

ObstacleDistance distanceTo(const ContactShape& shape, const Transform& place, const Grid& grid,
                            const Field3& position) {
  ObstacleDistance found = Search(shape, place, grid, position).run();
  found.on_cloth = place.toWorld(found.on_cloth);
  found.on_obstacle = place.toWorld(found.on_obstacle);
  return found;
}

}  // namespace curtain
