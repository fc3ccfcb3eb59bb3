// SPDX-License-Identifier: BSD-3-Clause
//
// A closed mesh that is neither convex nor smooth.
#pragma once

#include <cmath>

#include "curtain_sim/obstacle_shape.h"
#include "testing.h"

namespace curtain_test {

/// Radius 1 times 1 + wiggle, with so many waves around and along its axis; 2 (rings - 1) segments triangles.
inline curtain::ShapeTriangles bumpySphere(int rings, int segments, double wiggle, double around = 5.0,
                                           double along = 3.0) {
  curtain::ShapeTriangles mesh;
  const auto add = [&](double latitude, double longitude) {
    const double radius = 1.0 + wiggle * std::sin(around * longitude) * std::cos(along * latitude) * std::cos(latitude);
    mesh.corners.emplace_back(radius * std::cos(latitude) * std::cos(longitude),
                              radius * std::cos(latitude) * std::sin(longitude), radius * std::sin(latitude));
  };
  add(-0.5 * kPi, 0.0);
  for (int r = 1; r < rings; ++r) {
    for (int s = 0; s < segments; ++s) {
      add(kPi * (static_cast<double>(r) / rings - 0.5), 2.0 * kPi * s / segments);
    }
  }
  add(0.5 * kPi, 0.0);
  const auto corner = [segments](int ring, int s) { return 1 + (ring - 1) * segments + s % segments; };
  const int top = static_cast<int>(mesh.corners.size()) - 1;
  for (int s = 0; s < segments; ++s) {
    mesh.triangles.emplace_back(0, corner(1, s + 1), corner(1, s));
    for (int r = 1; r + 1 < rings; ++r) {
      mesh.triangles.emplace_back(corner(r, s), corner(r, s + 1), corner(r + 1, s + 1));
      mesh.triangles.emplace_back(corner(r, s), corner(r + 1, s + 1), corner(r + 1, s));
    }
    mesh.triangles.emplace_back(corner(rings - 1, s), corner(rings - 1, s + 1), top);
  }
  return mesh;
}

}  // namespace curtain_test
