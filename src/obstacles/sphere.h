// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "obstacles/convex_shape.h"
#include "obstacles/directions.h"
#include "obstacles/segment_distance.h"
#include "obstacles/surface_of_revolution.h"
#include "scene/pi.h"

namespace curtain {

/// Around the origin; radius [m], > 0.
class SphereShape final : public ConvexShape {
 public:
  explicit SphereShape(double radius) : ConvexShape(radius), radius_(radius) {}
  using ConvexShape::nearest;

  SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept override {
    SurfacePoint surface;
    double length = 0.0;
    surface.normal = unitBeside<Vec3>(point, beside, Vec3::UnitZ(), length);
    surface.distance = length - radius_;
    return surface;
  }
  double support(const Vec3& direction) const noexcept override { return radius_ * direction.norm(); }
  double smoothRadius() const noexcept override { return radius_; }
  ShapeTriangles triangles() const override {
    Profile profile;
    appendArc(radius_, 0.0, -0.5 * kPi, profile);
    profile.pop_back();  // the equator comes with the upper half
    appendArc(radius_, 0.0, 0.0, profile);
    return turnAboutZ(profile);
  }

 private:
  void minimise(const std::array<Vec3, 3>& corners, double, ElementMinimum& out) const noexcept override {
    minimiseAroundSegment(*this, radius_, 0.0, corners, out);
  }
  void minimise(const std::array<Vec3, 2>& ends, double, ElementMinimum& out) const noexcept override {
    minimiseAroundSegment(*this, radius_, 0.0, ends, out);
  }
  double radius_;
};

}  // namespace curtain
