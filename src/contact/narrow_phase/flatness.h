// SPDX-License-Identifier: BSD-3-Clause
//
// When is a patch of cloth so flat that no two parts of it can come close? In place of a normal cone and a test of the
// contour (Volino, Magnenat-Thalmann 1994, Efficient self-collision detection on smoothly discretized surface
// animations using geometrical shape regularity) one condition that needs no look at the contour.
//
// Let x(u, v) be piecewise linear over a convex domain, and J its Jacobian projected on two fixed orthonormal
// directions a, b. Along the straight way from q to p in the domain
//
//     (p - q) . (f(p) - f(q)) = integral of (p - q)^T J (p - q),  f = (x . a, x . b),
//     so  |x(p) - x(q)| >= lambda |p - q|,
//
// lambda the least eigenvalue of the symmetric part of J over all triangles. It is concave in J: what holds for two
// positions with the same a, b holds for all between. Triangles are known by the box that holds their x_u and x_v at
// both positions. With u and v rescaled so that the boxes' centres U, V are unit vectors at c = U . V, the symmetric
// square root of their Gram matrix is J at the centre:
//
//     a, b = (U + V) / (2 sqrt(1 + c)) +- (U - V) / (2 sqrt(1 - c)),  lambda = min(sqrt(1 + c), sqrt(1 - c)),
//
// and the box's half edges, seen along a and b, bound what J may differ from that. Deviations along the normal do not
// count. In the domain, two elements that share no node are as far apart as the least altitude of a triangle: a vertex
// sees the rest of the mesh behind the far edges of the triangles around it, and of two segments that do not cross, one
// end is nearest.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace curtain {

/// Axis-aligned box in single precision, the fourth lane is 0.
struct FloatBox {
  Eigen::Array4f low;   ///< [m]
  Eigen::Array4f high;  ///< [m]

  void merge(const FloatBox& other) noexcept {
    low = low.min(other.low);
    high = high.max(other.high);
  }
  /// Whether the gap along every axis is at most reach [m].
  bool meets(const FloatBox& other, float reach) const noexcept {
    const Eigen::Array4f gap = (low - other.high).max(other.low - high);
#ifdef __SSE2__
    return _mm_movemask_ps(_mm_cmpgt_ps(_mm_loadu_ps(gap.data()), _mm_set1_ps(reach))) == 0;
#else
    return !(gap.maxCoeff() > reach);
#endif
  }
};

/// What x_u and x_v of all triangles of a patch are within, and the patch's spacing.
struct PatchSlopes {
  FloatBox u, v;           ///< of the derivatives along weft and warp [1]
  float spacing_u = 0.0f;  ///< least reference spacing of the columns [m]
  float spacing_v = 0.0f;  ///< least reference spacing of the rows [m]

  void merge(const PatchSlopes& other) noexcept {
    u.merge(other.u);
    v.merge(other.v);
    spacing_u = std::min(spacing_u, other.spacing_u);
    spacing_v = std::min(spacing_v, other.spacing_v);
  }
};

/// Whether any two elements of the patch that share no node are further apart than `reach` [m] at all times between
/// both positions, by the bound above; false: may be, or not. `rounding` [m]: the most by which a difference of two
/// coordinates was rounded.
inline bool isFlatBeyond(float reach, const PatchSlopes& patch, float rounding) noexcept {
  using Eigen::Array4f;
  constexpr float kUlps = 1e-6f;   // of a slope: of its quotient and of the box's centre and half edges
  constexpr float kSlack = 2e-5f;  // of lambda: U, V, a, b are rounded, by more where c is close to 1
  constexpr float kLeastSine = 0.1f;
  const Array4f mid_u = 0.5f * (patch.u.low + patch.u.high), mid_v = 0.5f * (patch.v.low + patch.v.high);
  const Array4f half_u = 0.5f * (patch.u.high - patch.u.low), half_v = 0.5f * (patch.v.high - patch.v.low);
  const float squared_u = (mid_u * mid_u).sum(), squared_v = (mid_v * mid_v).sum();
  const float side_u = patch.spacing_u * patch.spacing_u * squared_u;  // [m^2]
  const float side_v = patch.spacing_v * patch.spacing_v * squared_v;
  // The altitude of flat cloth may be too little already, and deviations along U or V too large; neither takes a root.
  const bool hopeless = !(side_u * side_v > reach * reach * (side_u + side_v)) ||
                        !((mid_u.abs() * half_u).sum() < squared_u) || !((mid_v.abs() * half_v).sum() < squared_v) ||
                        !(std::min(squared_u, squared_v) > 1e-6f);
  if (hopeless) return false;
  const float per_u = 1.0f / std::sqrt(squared_u), per_v = 1.0f / std::sqrt(squared_v);
  const Array4f unit_u = mid_u * per_u, unit_v = mid_v * per_v;
  const float cosine = (unit_u * unit_v).sum();
  const float plus = std::sqrt(std::max(0.0f, 1.0f + cosine)), minus = std::sqrt(std::max(0.0f, 1.0f - cosine));
  const float lambda = std::min(plus, minus);
  if (!(lambda > kLeastSine)) return false;
  const Array4f mean = (unit_u + unit_v) * (0.5f / plus), skew = (unit_u - unit_v) * (0.5f / minus);
  const Array4f a = (mean + skew).abs(), b = (mean - skew).abs();
  const Array4f most_u = (half_u + (rounding / patch.spacing_u + kUlps)) * per_u + kUlps;
  const Array4f most_v = (half_v + (rounding / patch.spacing_v + kUlps)) * per_v + kUlps;
  const float along_a = (a * most_u).sum(), along_b = (b * most_v).sum();
  const float across = 0.5f * ((b * most_u).sum() + (a * most_v).sum());
  const float half = 0.5f * (along_a - along_b);
  const float deviation = 0.5f * (along_a + along_b) + std::sqrt(half * half + across * across);
  const float least = lambda - deviation - kSlack;
  const float altitude_squared = side_u * side_v / (side_u + side_v);
  return least > 0.0f && least * least * altitude_squared * (1.0f - 1e-5f) > reach * reach;
}

}  // namespace curtain
