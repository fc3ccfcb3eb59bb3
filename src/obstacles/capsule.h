// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "obstacles/convex_shape.h"
#include "obstacles/directions.h"
#include "obstacles/segment_distance.h"
#include "obstacles/surface_of_revolution.h"
#include "scene/pi.h"

namespace curtain {

/// Along z, centred; radius and distance of the caps' centres [m], > 0.
class CapsuleShape final : public ConvexShape {
 public:
  CapsuleShape(double radius, double length)
      : ConvexShape(radius + 0.5 * length), radius_(radius), half_(0.5 * length) {}
  using ConvexShape::nearest;

  SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept override {
    const Vec3 foot(0.0, 0.0, std::clamp(point.z(), -half_, half_));
    const Vec3 across(beside.x(), beside.y(), 0.0);
    SurfacePoint surface;
    double length = 0.0;
    surface.normal = unitBeside<Vec3>(point - foot, across, Vec3::UnitX(), length);
    surface.distance = length - radius_;
    return surface;
  }
  double support(const Vec3& direction) const noexcept override {
    return radius_ * direction.norm() + half_ * std::abs(direction.z());
  }
  double smoothRadius() const noexcept override { return radius_; }
  ShapeTriangles triangles() const override {
    Profile profile;
    appendArc(radius_, -half_, -0.5 * kPi, profile);
    appendArc(radius_, half_, 0.0, profile);
    return turnAboutZ(profile);
  }

 private:
  void minimise(const std::array<Vec3, 3>& corners, double, ElementMinimum& out) const noexcept override {
    minimiseAroundSegment(*this, radius_, half_, corners, out);
  }
  void minimise(const std::array<Vec3, 2>& ends, double, ElementMinimum& out) const noexcept override {
    minimiseAroundSegment(*this, radius_, half_, ends, out);
  }
  double radius_;
  double half_;
};

}  // namespace curtain
