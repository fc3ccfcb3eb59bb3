// SPDX-License-Identifier: BSD-3-Clause
//
// What a snapshot carries of this floor. The pattern follows from the scene.
#include "cloth/archive.h"
#include "cloth/link_ways.h"

namespace curtain {

// Nothing but finite places and speeds: contact casts them to integers.
void ClothState::carry(Archive& archive) {
  archive.finite("position", position);
  archive.finite("velocity", velocity);
  archive.finite("velocity_age", velocity_age);
}

// A companion looks before its frame says whether links hold: as the last one did.
void SampledBounds::carry(Archive& archive) { archive.number("margin", margin_); }

}  // namespace curtain
