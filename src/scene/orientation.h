// SPDX-License-Identifier: BSD-3-Clause
//
// When a quaternion in an input counts as a rotation.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace curtain {

/// Quaternions typed with three digits are meant as rotations; those further off are a mistake.
constexpr double kUnitTolerance = 1e-3;

/// False for NaN.
inline bool isNearlyUnit(const Eigen::Quaterniond& q) { return std::abs(q.norm() - 1.0) <= kUnitTolerance; }

/// The unit quaternion near q; q itself when it is none, or when it is unit to rounding: dividing again would change
/// its last bits, and scenes must read back as they were written.
inline Eigen::Quaterniond nearlyUnit(const Eigen::Quaterniond& q) {
  constexpr double kRounding = 1e-14;
  return isNearlyUnit(q) && std::abs(q.norm() - 1.0) > kRounding ? q.normalized() : q;
}

}  // namespace curtain
