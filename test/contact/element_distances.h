// SPDX-License-Identifier: BSD-3-Clause
//
// Distances of the mesh's elements, for tests that look at many instants of a motion.
#pragma once

#include <algorithm>
#include <cmath>

#include "obstacles/triangle_mesh_tree.h"

namespace curtain_test {

inline double distanceOfSegments(const curtain::Vec3& p, const curtain::Vec3& q, const curtain::Vec3& r,
                                 const curtain::Vec3& s) {
  // Ericson, Real-Time Collision Detection, 5.1.9.
  const curtain::Vec3 d = q - p, e = s - r, w = p - r;
  const double a = d.squaredNorm(), b = d.dot(e), c = d.dot(w), f = e.dot(w), g = e.squaredNorm();
  const double volume = a * g - b * b;
  double along = volume > 0.0 ? std::clamp((b * f - c * g) / volume, 0.0, 1.0) : 0.0;
  double other = (b * along + f) / g;
  if (other < 0.0 || other > 1.0) {
    other = std::clamp(other, 0.0, 1.0);
    along = std::clamp((b * other - c) / a, 0.0, 1.0);
  }
  return (p + along * d - r - other * e).norm();
}

inline double distanceToTriangle(const curtain::Vec3& p, const curtain::Vec3& a, const curtain::Vec3& b,
                                 const curtain::Vec3& c) {
  return std::sqrt(curtain::nearestOnTriangle(p, a, b, c).distance_squared);
}

}  // namespace curtain_test
