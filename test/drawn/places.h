// SPDX-License-Identifier: BSD-3-Clause
//
// Where things are in scenes that are made up by habit: cloth hangs about as wide as it is, and what acts on it does so
// in the first second or two.
#pragma once

#include "cloth/cloth.h"
#include "drawn/choices.h"

namespace curtain_test {

/// A line to hang from.
void placeCloth(curtain::Scene& scene, Choices& choices);
/// Another cloth before or behind the first, so near that they touch.
void placeBeside(const curtain::Scene& first, Choices& choices, curtain::HangParams& hang, double width);
/// Winds, drags, lines and obstacles, of cloth that is known. fastest: of the obstacles [m/s].
void placeThings(curtain::Scene& scene, Choices& choices, double fastest);
/// Hands at nodes, wherever these are at the start. Two that do not give could be drawn through each other with what
/// they hold: of those there is one, and none beside lines.
void placeHands(curtain::Scene& scene, Choices& choices, const curtain::ClothPattern& pattern,
                const curtain::Field3& start);

}  // namespace curtain_test
