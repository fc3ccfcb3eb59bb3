// SPDX-License-Identifier: BSD-3-Clause
//
// How much a motion amplifies what is a little off, so that tolerances can be derived: a motion in which every number
// of the scene is off by a share tells what becomes of rounding, or of what the solver leaves over.
#pragma once

#include <cstdint>

#include "curtain_sim/scene.h"
#include "properties/motion.h"

namespace curtain_test {

/// The scene with its numbers off by up to this share: lengths, masses, forces, and of what has a direction that too.
curtain::Scene disturbed(curtain::Scene scene, double share, std::uint64_t seed);

/// How far a share moves the nodes [m]: the largest distance to any of `tries` motions that are off by `share`, over
/// it.
double growthOf(const curtain::Scene& scene, const Motion& motion, double share, std::uint64_t seed, int tries = 2);

/// The longest that a weft link is in a motion, over its length: below 1, no string has pulled.
double longestString(const curtain::Scene& scene, const Motion& motion);

/// A string may have pulled, in a frame as well: that is how fast its ends part at a frame's end, for as long as a
/// frame.
bool stringsMayPull(const curtain::Scene& scene, const Motion& motion);

/// Share of a force that single precision may take: 2^-24 of each correction, and about as much for each of the
/// iterations whose errors the next ones do not see, eight at most.
constexpr double kSingle = 8.0 * 0x1p-24;

/// The share of gravity that rounding amounts to, if all of it went one way: positions of this size [m] are rounded by
/// 2^-53 of it once a substep of h seconds, which is an acceleration of 2^-53 size / h^2. h: the shortest substep of a
/// motion of so many frames, taken for half of their mean, over `stages`.
double roundingShare(const curtain::Scene& scene, const Motion& motion, double size);

}  // namespace curtain_test
