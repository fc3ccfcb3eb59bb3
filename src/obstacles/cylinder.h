// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "obstacles/convex_shape.h"
#include "obstacles/directions.h"
#include "obstacles/surface_of_revolution.h"

namespace curtain {

/// Along z, centred; radius and length [m], > 0.
class CylinderShape final : public ConvexShape {
 public:
  CylinderShape(double radius, double length)
      : ConvexShape(radius + 0.5 * length), radius_(radius), half_(0.5 * length) {}
  using ConvexShape::nearest;

  SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept override {
    double radial = 0.0;
    const Eigen::Vector2d outward =
        unitBeside<Eigen::Vector2d>(point.head<2>(), beside.head<2>(), Eigen::Vector2d::UnitX(), radial);
    const Eigen::Vector2d beyond(radial - radius_, std::abs(point.z()) - half_);  // beyond the side, beyond the end
    SurfacePoint surface;
    Eigen::Vector2d profile = beyond[0] >= beyond[1] ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
    surface.distance = beyond.maxCoeff();
    if (surface.distance > 0.0) profile = unitOr<Eigen::Vector2d>(beyond.cwiseMax(0.0), profile, surface.distance);
    surface.normal << profile[0] * outward, profile[1] * sideOf(point.z(), beside.z());
    return surface;
  }
  double support(const Vec3& direction) const noexcept override {
    return radius_ * direction.head<2>().norm() + half_ * std::abs(direction.z());
  }
  ShapeTriangles triangles() const override {
    return turnAboutZ({{0.0, -half_}, {radius_, -half_}, {radius_, half_}, {0.0, half_}});
  }

 private:
  double radius_;
  double half_;
};

}  // namespace curtain
