// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 8: what a drape meter reads of the round sample: its shadow and its rim.
#pragma once

#include "cloth/cloth.h"

namespace curtain_fit {

/// Cusick's drape coefficient: the shadow of sample and disc, less the disc, over the flat ring around the disc.
double drapeCoefficient(const curtain::ClothPattern& pattern, const curtain::Field3& position);

/// The rim, evenly in its angle from the weft's direction on, [points] [m].
std::vector<curtain::Vec3> rimOf(const curtain::Grid& grid, const curtain::Field3& position, int points);

/// How often the rim stands out: how often its distance from the axis goes from below its mean to above it, by a tenth
/// of its range each.
int countFolds(const std::vector<curtain::Vec3>& rim);

}  // namespace curtain_fit
