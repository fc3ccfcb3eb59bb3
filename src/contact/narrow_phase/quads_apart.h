// SPDX-License-Identifier: BSD-3-Clause
//
// Does a plane keep two quads apart on their straight ways? Along a fixed direction places are linear in time, so it is
// enough that it does where the ways start and where they end, on the same side.
#pragma once

#include "contact/narrow_phase/staying_apart.h"

namespace curtain {

/// Corners of two quads, as in QuadElements::corners.
struct TwoQuads {
  FourNodes one, other;
};

/// Bit k is set where the quads of pair k are certain to stay further apart than `reach` [m]. Differences of two places
/// may be rounded by `rounding` [m]. Asked of the directions between their middles and across each of them.
std::uint32_t quadsStayApart(const std::array<TwoQuads, kPairsAtOnce>& pairs, const NodeWays& ways, float reach,
                             float rounding) noexcept;
/// The same of the directions between points that come closer and closer, half way (Gilbert 1966), which finds nearly
/// all that there are.
std::uint32_t quadsStayApartSomehow(const std::array<TwoQuads, kPairsAtOnce>& pairs, const NodeWays& ways, float reach,
                                    float rounding) noexcept;

}  // namespace curtain
