// SPDX-License-Identifier: BSD-3-Clause
//
// Do two elements stay apart on their straight ways? Along a fixed direction places are linear in time: what is further
// apart than the reach where the ways start, and on the same side where they end, was so all the time. Any direction
// proves it; the one between the points that are closest half way does so for nearly all pairs that stay apart.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

namespace curtain {

/// Nodes of two elements that share none: of a vertex and a triangle, or of two edges.
using FourNodes = std::array<std::uint32_t, 4>;

/// Where nodes are at two instants, by their indices [m]; the fourth lane is 0.
struct NodeWays {
  const Eigen::Array4f *start, *end;
};

/// Eight pairs at once.
constexpr std::size_t kPairsAtOnce = 8;

/// Bit k is set where the elements of pair k are certain to stay further apart than `reach` [m]. Differences of two
/// places may be rounded by `rounding` [m].
std::uint32_t edgesStayApart(const std::array<FourNodes, kPairsAtOnce>& pairs, const NodeWays& ways, float reach,
                             float rounding) noexcept;
std::uint32_t vertexStaysApart(const std::array<FourNodes, kPairsAtOnce>& pairs, const NodeWays& ways, float reach,
                               float rounding) noexcept;

}  // namespace curtain
