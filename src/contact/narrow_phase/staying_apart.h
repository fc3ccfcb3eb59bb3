// SPDX-License-Identifier: BSD-3-Clause
//
// Do two elements stay apart on their straight ways? Along a fixed direction places are linear in time: what is further
// apart than the reach where the ways start, and on the same side where they end, was so all the time. Any direction
// proves it; the one between the points that are closest half way does so for nearly all pairs that stay apart.
#pragma once

#include <array>
#include <cstdint>

#include "contact/narrow_phase/candidates.h"
#include "contact/narrow_phase/element_boxes.h"

namespace curtain {

/// Nodes of two elements that share none: of a vertex and a triangle, or of two edges.
using FourNodes = std::array<std::uint32_t, 4>;

inline FourNodes nodesOf(const VertexTriangle& c) { return {c.vertex, c.triangle[0], c.triangle[1], c.triangle[2]}; }
inline FourNodes nodesOf(const EdgeEdge& c) { return {c.first[0], c.first[1], c.second[0], c.second[1]}; }

/// Bit k is set where the elements of pair k of four are certain to stay further apart than `reach` [m]. Differences of two
/// places may be rounded by `rounding` [m].
std::uint32_t edgesStayApart(const std::array<FourNodes, 4>& pairs, const NodeWay* ways, float reach,
                             float rounding) noexcept;
std::uint32_t vertexStaysApart(const std::array<FourNodes, 4>& pairs, const NodeWay* ways, float reach,
                               float rounding) noexcept;

}  // namespace curtain
