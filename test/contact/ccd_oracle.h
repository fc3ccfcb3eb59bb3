// SPDX-License-Identifier: BSD-3-Clause
//
// The distance of a vertex and a triangle or of two edges in long double, from nothing but projections on points, lines
// and planes: slow, and of no common origin with src/contact.
#pragma once

#include <algorithm>
#include <cmath>

#include "ccd_truth.h"

namespace curtain_test {

using Real = long double;
using Vec3l = Eigen::Matrix<Real, 3, 1>;

inline Real distanceToSegment(const Vec3l& p, const Vec3l& a, const Vec3l& b) {
  const Vec3l ab = b - a;
  const Real squared = ab.squaredNorm();
  const Real along = squared > 0.0L ? std::clamp((p - a).dot(ab) / squared, 0.0L, 1.0L) : 0.0L;
  return (p - a - along * ab).norm();
}

/// Least value of a function of one valley, by golden section.
template <typename Function>
Real minOfConvex(const Function& function, Real low = 0.0L, Real high = 1.0L) {
  constexpr Real kGolden = 0.6180339887498948482L;
  for (int i = 0; i < 60; ++i) {
    const Real one = high - kGolden * (high - low);
    const Real other = low + kGolden * (high - low);
    if (function(one) < function(other)) {
      high = other;
    } else {
      low = one;
    }
  }
  return function(0.5L * (low + high));
}

/// Sine below which a plane's normal has lost too many digits even here.
constexpr Real kThin = 1e-5L;

inline Real distanceToTriangle(const Vec3l& p, const Vec3l& a, const Vec3l& b, const Vec3l& c) {
  Real least = std::min({distanceToSegment(p, a, b), distanceToSegment(p, b, c), distanceToSegment(p, c, a)});
  const Vec3l n = (b - a).cross(c - a);
  if (!(n.norm() > kThin * std::max((b - a).squaredNorm(), (c - a).squaredNorm()))) {
    // Segments across the triangle, side by side.
    return std::min(
        least, minOfConvex([&](Real s) -> Real { return distanceToSegment(p, a + s * (c - a), b + s * (c - b)); }));
  }
  const bool inside =
      n.dot((b - a).cross(p - a)) >= 0.0L && n.dot((c - b).cross(p - b)) >= 0.0L && n.dot((a - c).cross(p - c)) >= 0.0L;
  if (inside) least = std::min(least, std::abs(n.dot(p - a)) / n.norm());
  return least;
}

inline Real distanceOfSegments(const Vec3l& a, const Vec3l& b, const Vec3l& c, const Vec3l& d) {
  Real least = std::min(
      {distanceToSegment(a, c, d), distanceToSegment(b, c, d), distanceToSegment(c, a, b), distanceToSegment(d, a, b)});
  const Vec3l n = (b - a).cross(d - c);
  if (!(n.norm() > kThin * (b - a).norm() * (d - c).norm())) {
    return std::min(least, minOfConvex([&](Real s) { return distanceToSegment(a + s * (b - a), c, d); }));
  }
  // Seen along n the segments cross where each has its ends on both sides of the other.
  const auto side = [&n](const Vec3l& from, const Vec3l& to, const Vec3l& p) {
    return n.dot((to - from).cross(p - from));
  };
  const bool cross = side(a, b, c) * side(a, b, d) <= 0.0L && side(c, d, a) * side(c, d, b) <= 0.0L;
  if (cross) least = std::min(least, std::abs(n.dot(c - a)) / n.norm());
  return least;
}

/// At the time t.
inline Real distanceAt(bool edges, const CcdPoints& x, Real t) {
  const auto at = [&x, t](std::size_t i) -> Vec3l {
    const Vec3l start = x[i].cast<Real>();
    return start + t * (x[i + 4].cast<Real>() - start);
  };
  return edges ? distanceOfSegments(at(0), at(1), at(2), at(3)) : distanceToTriangle(at(0), at(1), at(2), at(3));
}

/// Least distance over [0, last]: evenly spaced samples, each valley between three of them searched by golden section.
inline Real minDistance(bool edges, const CcdPoints& x, Real last, int samples) {
  const auto at = [&](int k) { return distanceAt(edges, x, last * k / samples); };
  Real least = std::min(at(0), at(samples));
  for (int k = 1; k < samples; ++k) {
    const Real here = at(k);
    if (here > at(k - 1) || here > at(k + 1)) continue;
    const auto distance = [&](Real t) { return distanceAt(edges, x, t); };
    least = std::min({least, here, minOfConvex(distance, last * (k - 1) / samples, last * (k + 1) / samples)});
  }
  return least;
}

}  // namespace curtain_test
