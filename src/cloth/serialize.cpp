// SPDX-License-Identifier: BSD-3-Clause
//
// Serialization of this floor. The pattern follows from the scene.
#include "cloth/archive.h"
#include "cloth/stage_clock.h"

namespace curtain {

// Finite values only: contact casts positions to integers.
void ClothState::serialize(Archive& archive) {
  archive.finite("position", position);
  archive.finite("velocity", velocity);
  archive.finite("velocity_age", velocity_age);
  archive.finite("place", place);
  archive.finite("reach", reach);
}

void StageClock::serialize(Archive& archive) {
  for (double& seconds : seconds_) archive.number("seconds", seconds);
}

}  // namespace curtain
