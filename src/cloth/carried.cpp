// SPDX-License-Identifier: BSD-3-Clause
//
// Serialization of this floor. The pattern follows from the scene.
#include "cloth/archive.h"

namespace curtain {

// Finite values only: contact casts positions to integers.
void ClothState::carry(Archive& archive) {
  archive.finite("position", position);
  archive.finite("velocity", velocity);
  archive.finite("velocity_age", velocity_age);
  archive.finite("place", place);
  archive.finite("reach", reach);
}

}  // namespace curtain
