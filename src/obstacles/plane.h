// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "obstacles/convex_shape.h"

namespace curtain {

/// The half space z < 0 is solid.
class PlaneShape final : public ConvexShape {
 public:
  PlaneShape() : ConvexShape(0.0) {}
  using ConvexShape::nearest;

  SurfacePoint nearest(const Vec3& point, const Vec3&) const noexcept override { return {point.z(), Vec3::UnitZ()}; }
  double support(const Vec3& direction) const noexcept override {
    const bool up = direction.z() > 0.0 && direction.head<2>().isZero(0.0);
    return up ? 0.0 : std::numeric_limits<double>::infinity();
  }
  double smoothRadius() const noexcept override { return std::numeric_limits<double>::infinity(); }
  /// For drawing: a finite square.
  ShapeTriangles triangles() const override {
    constexpr double kHalf = 5.0;  // [m]
    return {{{-kHalf, -kHalf, 0.0}, {kHalf, -kHalf, 0.0}, {kHalf, kHalf, 0.0}, {-kHalf, kHalf, 0.0}},
            {{0, 1, 2}, {0, 2, 3}}};
  }
};

}  // namespace curtain
