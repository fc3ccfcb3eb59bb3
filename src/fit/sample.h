// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 8: the round sample of the drape test as a pattern of the engine.
#pragma once

#include "cloth/cloth.h"

namespace curtain_fit {

/// A scene of a square sheet with these properties that lies flat at z = 0 around the origin, pinned where the disc is.
/// It sinks in still air. Row 0 is at the largest y.
curtain::Scene sheetOf(const curtain::ClothParams& cloth, int nodes);

/// Its pattern, of which the circle is left.
curtain::ClothPattern roundSample(const curtain::Scene& sheet);

/// Place of a node when the sheet is flat [m].
curtain::Vec3 flatPlace(const curtain::Grid& grid, int row, int column);

}  // namespace curtain_fit
