// SPDX-License-Identifier: BSD-3-Clause
//
// Rotation vectors and their rates. By power series alone: the bits of sin, cos and atan2 depend on the processor,
// since the C library fuses multiplications where it can.
#pragma once

#include <cmath>

#include "curtain_sim/scene.h"
#include "scene/pi.h"

namespace curtain {

// Of small angles only the first terms count.

/// Sum of (-y)^k / (2 k)!, which is cos(x), and of (-y)^k / (2 k + 1)!, sin(x) / x, y = x^2 <= pi^2.
struct EvenSeries {
  double cosine = 1.0, sinc = 1.0;
  explicit EvenSeries(double y) noexcept {
    for (int k = y < 0.07 ? 6 : 15; k > 0; --k) {
      cosine = 1.0 - y / ((2 * k - 1) * (2 * k)) * cosine;
      sinc = 1.0 - y / ((2 * k) * (2 * k + 1)) * sinc;
    }
  }
};

/// The rotation of a rotation vector [rad].
inline Eigen::Quaterniond rotationOf(const Vec3& turn) noexcept {
  const double angle = turn.norm();
  const double within = angle <= 2.0 * kPi ? 1.0 : std::remainder(angle, 4.0 * kPi) / angle;  // remainder() is exact
  const Vec3 half = 0.5 * within * turn;
  const EvenSeries of(half.squaredNorm());
  Eigen::Quaterniond rotation;
  rotation.w() = of.cosine;
  rotation.vec() = of.sinc * half;
  return rotation;
}

/// Its rotation vector, by the shorter way. With h the half angle, tan(h / 2) = sin(h) / (1 + cos(h)), and once more
/// halved it is below 0.42, where the series of atan converges fast.
inline Vec3 rotationVectorOf(const Eigen::Quaterniond& rotation) noexcept {
  const double sign = rotation.w() < 0.0 ? -1.0 : 1.0, cosine = sign * rotation.w();
  const double per_sine = 1.0 / (1.0 + cosine), t = rotation.vec().norm() * per_sine;
  const double per_t = 1.0 / (1.0 + std::sqrt(1.0 + t * t)), y = t * per_t * (t * per_t);
  double sum = 0.0;
  for (int k = y < 0.005 ? 6 : 22; k >= 0; --k) sum = 1.0 / (2 * k + 1) - y * sum;
  return (8.0 * sign * sum * per_sine * per_t) * rotation.vec();
}

// The rotation vector r changes at r' = J^-1 w where a body turned by r spins at w in world axes; J is SO(3)'s left
// Jacobian (Sola, Deray and Atchuthan 2018, "A micro Lie theory", Eqs. (145) and (146)). (1 - cos) / angle^2 is half
// the square of sinc(angle / 2).

/// w of r'.
inline Vec3 spinOf(const Vec3& turn, const Vec3& slope) noexcept {
  const double square = turn.squaredNorm();
  const EvenSeries half(0.25 * square);
  double third = 1.0;  // 6 (angle - sin(angle)) / angle^3
  for (int k = 15; k > 0; --k) third = 1.0 - square / ((2 * k + 2) * (2 * k + 3)) * third;
  const Vec3 once = turn.cross(slope);
  return slope + (0.5 * half.sinc * half.sinc) * once + (third / 6.0) * turn.cross(once);
}

/// r' of w. With h = angle / 2, (1 - h / tan(h)) / angle^2 is (sinc(h) - cos(h)) / h^2 over 4 sinc(h).
inline Vec3 slopeOf(const Vec3& turn, const Vec3& spin) noexcept {
  const double y = 0.25 * turn.squaredNorm();
  double difference = 0.0;  // sum of (-y)^k (2 k + 2) / (2 k + 3)!, by its terms
  double term = 1.0 / 3.0;
  for (int k = 0; k < 16; ++k) {
    difference += term;
    term *= -y * (2 * k + 4) / ((2 * k + 2) * ((2 * k + 4) * (2.0 * k + 5)));
  }
  const Vec3 once = turn.cross(spin);
  return spin - 0.5 * once + (difference / (4.0 * EvenSeries(y).sinc)) * turn.cross(once);
}

}  // namespace curtain
