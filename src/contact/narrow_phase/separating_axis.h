// SPDX-License-Identifier: BSD-3-Clause
//
// Separating axis tests over a motion, eight pairs at once. Along a fixed direction positions are linear in time: two
// convex sets that are further apart than the reach along it at the start, and on the same side at the end, were so
// throughout. Any direction that separates is a proof; each test tries a few likely ones. Pairs without a proof remain
// candidates.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace curtain {

/// Nodes of two elements without a common node: a vertex and a triangle, or two edges.
using FourNodes = std::array<std::uint32_t, 4>;

/// Corners of two quads, as in QuadElements::corners.
struct TwoQuads {
  FourNodes one, other;
};

/// Positions at the start and the end of a motion, by node [m]; the fourth lane is 0.
struct SweptNodes {
  const Eigen::Array4f *start, *end;
};

constexpr std::size_t kPairsAtOnce = 8;

/// Bit k is set where pair k is proven to stay further apart than `reach` [m]. rounding [m]: largest rounding error of
/// a difference of two positions. Edges and vertices: along the direction between the closest points half way, which
/// separates nearly all pairs that can be separated.
std::uint32_t edgesSeparated(const std::array<FourNodes, kPairsAtOnce>& pairs, const SweptNodes& swept, float reach,
                             float rounding) noexcept;
std::uint32_t vertexSeparated(const std::array<FourNodes, kPairsAtOnce>& pairs, const SweptNodes& swept, float reach,
                              float rounding) noexcept;
/// Quads: along the direction between their centres and along their normals.
std::uint32_t quadsSeparated(const std::array<TwoQuads, kPairsAtOnce>& pairs, const SweptNodes& swept, float reach,
                             float rounding) noexcept;
/// The same along directions from a few of Gilbert's iterations (1966) towards the closest points half way: dearer, and
/// proves more.
std::uint32_t quadsSeparatedByGilbert(const std::array<TwoQuads, kPairsAtOnce>& pairs, const SweptNodes& swept,
                                      float reach, float rounding) noexcept;

}  // namespace curtain
