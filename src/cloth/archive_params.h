// SPDX-License-Identifier: BSD-3-Clause
//
// Winds, drags, air and grasps in an archive: every key; loading rejects invalid values.
#pragma once

#include "cloth/archive.h"
#include "curtain_sim/grasp.h"

namespace curtain {

void serializeParams(Archive& archive, WindParams& wind);
void serializeParams(Archive& archive, DragParams& drag, const ClothParams& cloth);
void serializeParams(Archive& archive, AirParams& air);
void serializeParams(Archive& archive, GraspParams& grasp, const ClothParams& cloth);

}  // namespace curtain
