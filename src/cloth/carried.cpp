// SPDX-License-Identifier: BSD-3-Clause
//
// What a snapshot carries of this floor. The pattern follows from the scene.
#include "cloth/archive.h"

namespace curtain {

// Nothing but finite places and speeds: contact casts them to integers.
void ClothState::carry(Archive& archive) {
  archive.finite("position", position);
  archive.finite("velocity", velocity);
  archive.finite("velocity_age", velocity_age);
}

}  // namespace curtain
