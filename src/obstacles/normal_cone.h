// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "curtain_sim/scene.h"

namespace curtain {

/// Directions around an axis: bounds the normals of the faces at some features.
struct NormalCone {
  Vec3 axis = Vec3::UnitZ();  ///< unit
  double sine = 1.0;          ///< of the half angle, which is a right one at most; 1: any direction

  /// Widens it to hold a unit direction; zero: any.
  void hold(const Vec3& direction) noexcept {
    sine = axis.dot(direction) > 0.0 ? std::max(sine, axis.cross(direction).norm()) : 1.0;
  }
};

/// A cone around both. Any direction may be in it if it would be wider than a right angle.
inline NormalCone around(const NormalCone& a, const NormalCone& b) noexcept {
  const Vec3 sum = a.axis + b.axis;
  const double length = sum.norm();
  NormalCone both;
  if (!(length > 0.0) || a.sine >= 1.0 || b.sine >= 1.0) return both;
  both.axis = sum / length;
  // Of the angle between the axes, and then of that and a cone's own: sin(x + y).
  const double sine = both.axis.cross(a.axis).norm(), cosine = both.axis.dot(a.axis);
  const double wider = std::max(a.sine, b.sine), narrow = std::sqrt(1.0 - wider * wider);
  const double of_sum = sine * narrow + cosine * wider;
  both.sine = cosine * narrow - sine * wider > 0.0 ? std::min(1.0, of_sum) : 1.0;
  return both;
}

}  // namespace curtain
