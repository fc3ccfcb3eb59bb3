// SPDX-License-Identifier: BSD-3-Clause
//
// When a quaternion in an input counts as a rotation.
#pragma once

#include <cmath>

#include "curtain_sim/scene.h"

namespace curtain {

/// Allows for quaternions typed with three digits; larger deviations are mistakes.
constexpr double kUnitTolerance = 1e-3;

/// False for NaN.
inline bool isNearlyUnit(const Rotation& q) { return std::abs(q.norm() - 1.0) <= kUnitTolerance; }

/// Normalises q if it is nearly unit; one that is unit to rounding stays as it is, so that scenes read back with the
/// same bits.
inline Rotation nearlyUnit(const Rotation& q) {
  constexpr double kRounding = 1e-14;
  return isNearlyUnit(q) && std::abs(q.norm() - 1.0) > kRounding ? Rotation(q.normalized()) : q;
}

}  // namespace curtain
