// SPDX-License-Identifier: BSD-3-Clause
//
// When does a patch of cloth keep its parts apart because it is even? In place of a normal cone and a test of the
// contour (Volino, Magnenat-Thalmann 1994, Efficient self-collision detection on smoothly discretized surface
// animations using geometrical shape regularity) one condition that needs no look at the contour.
//
// Let x(u, v) be piecewise linear over a convex domain, and J its Jacobian projected on two fixed orthonormal
// directions a, b. Along the straight way from q to p in the domain
//
//     (p - q) . (f(p) - f(q)) = integral of (p - q)^T J (p - q),  f = (x . a, x . b),
//     so  |x(p) - x(q)| >= lambda |p - q|,
//
// lambda the least eigenvalue of the symmetric part of J over all triangles. With U, V the mean slopes' unit vectors
// and c = U . V, the symmetric square root of their Gram matrix is J for an even patch:
//
//     a, b = (U + V) / (2 sqrt(1 + c)) +- (U - V) / (2 sqrt(1 - c)).
//
// Deviations along the normal do not count. In the domain, two elements that share no node are as far apart as the
// least altitude of a triangle: a vertex sees the rest of the mesh behind the far edges of the triangles around it, and
// of two segments that do not cross, one end is nearest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// One over the reference spacing of columns and rows of quads [1/m]: means over the cloth, for any even grid will do.
/// Closed cloth has its first column once more behind the last; whole vectors may be read from any column.
struct Spacings {
  using Floats = std::vector<float, CacheAligned<float>>;
  explicit Spacings(const ClothPattern& pattern);
  Floats u, v;
};

/// Windows of one or two quads each way, eight side by side: first nodes next to each other in memory.
struct FlatWindows {
  static constexpr std::size_t kCount = 8;

  int high, wide;             ///< quads of one
  std::size_t stride;         ///< from a row of nodes to the next
  const float* places[2][3];  ///< of the first node at two instants, component by component [m]
  const float *per_spacing_u,
      *per_spacing_v;     ///< over the reference spacing of the columns and rows, from the first on [1/m]
  float reach, rounding;  ///< that elements are to be kept apart [m]; most by which a difference of two coordinates was
                          ///< rounded [m]

  /// Bit k: any two elements of window k that share no node are further apart than the reach at both instants, and at
  /// all times between if nodes move straight. What lies beyond the cloth means nothing.
  std::uint32_t find() const noexcept;
};

}  // namespace curtain
