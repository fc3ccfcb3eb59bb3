// SPDX-License-Identifier: BSD-3-Clause
//
// Winds, drags and air in an archive: every key of the scene's table; loading rejects invalid values.
#pragma once

#include "cloth/archive.h"

namespace curtain {

void carryParams(Archive& archive, WindParams& wind);
void carryParams(Archive& archive, DragParams& drag, const ClothParams& cloth);
void carryParams(Archive& archive, AirParams& air);

}  // namespace curtain
