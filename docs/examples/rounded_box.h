// SPDX-License-Identifier: BSD-3-Clause
//
// A new obstacle shape in one file (docs/add_a_shape.md).
#pragma once

#include <cmath>

#include "obstacles/box.h"

namespace curtain {

/// A box whose edges and corners are round: all points within `radius` of a smaller box. Centred, edges along the axes;
/// size over all [m], each above 2 radius; radius [m], > 0.
class RoundedBoxShape final : public ConvexShape {
 public:
  RoundedBoxShape(const Vec3& size, double radius)
      : ConvexShape(0.5 * size.maxCoeff()), core_((size.array() - 2.0 * radius).matrix()), radius_(radius) {}
  using ConvexShape::nearest;

  SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept override {
    SurfacePoint surface = core_.nearest(point, beside);
    surface.distance -= radius_;
    return surface;
  }
  double support(const Vec3& direction) const noexcept override {
    return core_.support(direction) + radius_ * direction.norm();
  }
  /// The faces are flat and the rest bends by the radius.
  double smoothRadius() const noexcept override { return radius_; }
  /// The flat box around it is enough to see where it is.
  ShapeTriangles triangles() const override {
    ShapeTriangles shape = core_.triangles();
    for (Vec3& corner : shape.corners) corner += radius_ * corner.cwiseSign();
    return shape;
  }

 private:
  BoxShape core_;
  double radius_;
};

}  // namespace curtain
