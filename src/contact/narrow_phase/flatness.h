// SPDX-License-Identifier: BSD-3-Clause
//
// Flatness condition: a patch of cloth that satisfies it has no self-contact. One condition replaces the normal cone
// and the contour test of Volino and Magnenat-Thalmann (1994, Efficient self-collision detection on smoothly
// discretized surface animations using geometrical shape regularity).
//
// Let x(u, v) be piecewise linear over a convex domain, and J its Jacobian projected on two fixed orthonormal
// directions a, b. Along the straight line from q to p in the domain
//
//     (p - q) . (f(p) - f(q)) = integral of (p - q)^T J (p - q),  f = (x . a, x . b),
//     so  |x(p) - x(q)| >= lambda |p - q|,
//
// lambda the least eigenvalue of the symmetric part of J over all triangles. With U, V the unit vectors of the mean
// slopes and c = U . V, J of a flat patch is the symmetric square root of their Gram matrix for
//
//     a, b = (U + V) / (2 sqrt(1 + c)) +- (U - V) / (2 sqrt(1 - c)).
//
// Deviations along the normal do not matter. Two elements without a common node are at least the least altitude of a
// triangle apart in the domain: a vertex sees the rest of the mesh behind the far edges of its triangles, and of two
// segments that do not cross one end is nearest.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// 1 / rest spacing of columns (u) and rows (v) of quads [1/m], mean over the cloth: the bound holds for any regular
/// grid. Closed cloth repeats its first column behind the last. A vector register may be loaded from any column.
struct Spacings {
  using Floats = std::vector<float, CacheAligned<float>>;
  explicit Spacings(const ClothPattern& pattern);
  Floats u, v;
};

/// Nodes of a regular grid during a motion, from the first of a window on.
struct FlatNodes {
  std::size_t stride;         ///< between rows of nodes [floats]
  const float* places[2][3];  ///< of the first node at both instants, by component [m]
  const float *per_spacing_u,
      *per_spacing_v;     ///< from the first column and row on [1/m]
  float reach, rounding;  ///< distance to prove; largest rounding error of a difference of two coordinates [m]
};

/// Eight windows of one or two quads either way (`high`, `wide`) whose first nodes are next to each other in memory.
/// Bit k: any two elements of window k without a common node are further apart than the reach throughout the motion.
/// Bits beyond the cloth are undefined.
std::uint32_t flatWindows(const FlatNodes& nodes, int high, int wide) noexcept;

}  // namespace curtain
