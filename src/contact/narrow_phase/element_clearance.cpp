// SPDX-License-Identifier: BSD-3-Clause
#include "contact/narrow_phase/element_clearance.h"

#include <algorithm>
#include <array>

#include "contact/narrow_phase/closest_points.h"
#include "obstacles/convex_shape.h"
#include "obstacles/obstacle_features.h"

namespace curtain {
namespace {

using Corners = std::array<Vec3, 3>;

Eigen::AlignedBox3d boxOf(const Corners& corners) {
  Eigen::AlignedBox3d box(corners[0]);
  return box.extend(corners[1]).extend(corners[2]);
}

/// Whether the segment p-q crosses the triangle. Not in its plane: there their edges meet.
bool crosses(const Vec3& p, const Vec3& q, const Corners& triangle) {
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  if (normal.dot(p - triangle[0]) * normal.dot(q - triangle[0]) >= 0.0) return false;
  bool none_left = true;
  bool none_right = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const double volume = (q - p).dot((triangle[k] - p).cross(triangle[(k + 1) % 3] - p));
    none_left = none_left && volume <= 0.0;
    none_right = none_right && volume >= 0.0;
  }
  return none_left || none_right;
}

/// Whether `other` is further than `clearance` on one side of the plane of `triangle`.
bool parts(const Corners& triangle, const Corners& other, double clearance) {
  const Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double limit = clearance * normal.norm();
  const double a = normal.dot(other[0] - triangle[0]);
  const double b = normal.dot(other[1] - triangle[0]);
  const double c = normal.dot(other[2] - triangle[0]);
  return std::min({a, b, c}) > limit || std::max({a, b, c}) < -limit;
}

bool areNear(const Corners& a, const Corners& b, double clearance) {
  if (parts(a, b, clearance) || parts(b, a, clearance)) return false;
  const double limit = clearance * clearance;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    if (crosses(a[k], a[next], b) || crosses(b[k], b[next], a)) return true;
    if (closestOnTriangle(a[k], b[0], b[1], b[2]).distance_squared < limit) return true;
    if (closestOnTriangle(b[k], a[0], a[1], a[2]).distance_squared < limit) return true;
    for (std::size_t m = 0; m < 3; ++m) {
      if (closestOnSegments(a[k], a[next], b[m], b[(m + 1) % 3]).distance_squared < limit) return true;
    }
  }
  return false;
}

}  // namespace

bool ElementClearance::keeps(const ContactShape& shape, const Transform& place, const std::vector<Vec3>& points,
                             const std::vector<MeshTriangle>& triangles, double clearance) {
  local_.clear();
  for (const Vec3& point : points) local_.push_back(place.toLocal(point));
  if (shape.convex() != nullptr) return keepsToConvex(*shape.convex(), triangles, clearance);
  return shape.features() == nullptr || keepsToMesh(*shape.features(), triangles, clearance);
}

bool ElementClearance::keepsToConvex(const ConvexShape& shape, const std::vector<MeshTriangle>& triangles,
                                     double clearance) {
  // Early out: a convex solid lies below its tangent plane at the point nearest to the patch's centre, and most
  // patches lie above.
  Vec3 middle = Vec3::Zero();
  for (const Vec3& point : local_) middle += point;
  middle /= static_cast<double>(local_.size());
  const SurfacePoint surface = shape.nearest(middle);
  heights_.clear();
  for (const Vec3& point : local_) heights_.push_back(surface.distance + surface.normal.dot(point - middle));
  ElementPoint nearest;
  for (const auto& [a, b, c] : triangles) {
    if (std::min({heights_[a], heights_[b], heights_[c]}) >= clearance) continue;
    const bool found = b == c ? shape.nearestOnEdge({local_[a], local_[b]}, clearance, nearest)
                              : shape.nearestOnTriangle({local_[a], local_[b], local_[c]}, clearance, nearest);
    if (found && nearest.surface.distance < clearance) return false;
  }
  return true;
}

bool ElementClearance::keepsToMesh(const ObstacleFeatures& features, const std::vector<MeshTriangle>& triangles,
                                   double clearance) {
  Eigen::AlignedBox3d box;
  for (const Vec3& point : local_) box.extend(point);
  const Vec3 margin = Vec3::Constant(clearance);
  near_.clear();
  features.forEachTriangleIn({box.min() - margin, box.max() + margin},
                             [&](std::uint32_t n, const ObstacleTriangle& face) {
                               double low = std::numeric_limits<double>::infinity();
                               double high = -low;
                               for (const Vec3& point : local_) {
                                 const double height = face.normal.dot(point - face.corners[0]);
                                 low = std::min(low, height);
                                 high = std::max(high, height);
                               }
                               if (low <= clearance && high >= -clearance) near_.push_back(n);
                             });
  if (near_.empty()) return true;
  for (const auto& [a, b, c] : triangles) {
    const Corners corners{local_[a], local_[b], local_[c]};
    const Eigen::AlignedBox3d own = boxOf(corners);
    const Eigen::AlignedBox3d around(own.min() - margin, own.max() + margin);
    for (const std::uint32_t n : near_) {
      const Corners& face = features.triangles()[n].corners;
      if (around.intersects(boxOf(face)) && areNear(corners, face, clearance)) return false;
    }
  }
  return true;
}

}  // namespace curtain
