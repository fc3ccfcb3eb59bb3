// SPDX-License-Identifier: BSD-3-Clause
#include "obstacles/surface_of_revolution.h"

#include <cmath>

#include "scene/pi.h"

namespace curtain {
namespace {

constexpr int kSegments = 48;  // around the axis
constexpr int kArcs = 12;      // pole to equator

}  // namespace

void appendArc(double radius, double centre, double from, Profile& profile) {
  for (int i = 0; i <= kArcs; ++i) {
    const double angle = from + 0.5 * kPi * i / kArcs;
    profile.emplace_back(radius * std::cos(angle), centre + radius * std::sin(angle));
  }
}

ShapeTriangles turnAboutZ(const Profile& profile) {
  ShapeTriangles shape;
  const int rings = static_cast<int>(profile.size()) - 2;  // without the poles
  shape.corners.emplace_back(0.0, 0.0, profile.front().y());
  for (int r = 1; r <= rings; ++r) {
    const Eigen::Vector2d& ring = profile[static_cast<std::size_t>(r)];
    for (int s = 0; s < kSegments; ++s) {
      const double angle = 2.0 * kPi * s / kSegments;
      shape.corners.emplace_back(ring.x() * std::cos(angle), ring.x() * std::sin(angle), ring.y());
    }
  }
  shape.corners.emplace_back(0.0, 0.0, profile.back().y());
  const int top = rings * kSegments + 1;
  const auto corner = [](int ring, int segment) { return 1 + ring * kSegments + segment % kSegments; };
  for (int s = 0; s < kSegments; ++s) {
    shape.triangles.emplace_back(0, corner(0, s + 1), corner(0, s));
    for (int r = 0; r + 1 < rings; ++r) {
      shape.triangles.emplace_back(corner(r, s), corner(r, s + 1), corner(r + 1, s + 1));
      shape.triangles.emplace_back(corner(r, s), corner(r + 1, s + 1), corner(r + 1, s));
    }
    shape.triangles.emplace_back(corner(rings - 1, s), corner(rings - 1, s + 1), top);
  }
  return shape;
}

}  // namespace curtain
