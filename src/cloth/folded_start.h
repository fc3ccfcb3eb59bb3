// SPDX-License-Identifier: BSD-3-Clause
//
// Start of cloth that is gathered and whose wefts push (parts/weft_push): its rows lie in folds, where wefts are as
// long as they are. Of cloth that is placed without folds each row's course in plan is kept, and bent to one side and
// the other by turns; columns meet the course where they are hung.
//
//     from above      __        __
//                    /  \      /  \              .  hung columns; the course goes straight from one to the next
//                   .    .    .    .    .
//                         \__/      \__/
#pragma once

#include "cloth/cloth.h"

namespace curtain {

/// Whether wefts of this cloth push.
inline bool weftsPush(const ClothParams& cloth) { return cloth.shear > 0.0 && cloth.bending_weft > 0.0; }

/// Lays cloth in folds, its rods at their lengths. Where rods are too short for folds it is left as it is.
///   down      unit vector along which columns hang
///   position  of all nodes, shape [grid.size()] [m]; in: without folds, rods at their lengths and no weft overlong
void foldStart(const Scene& scene, const ClothPattern& pattern, const Vec3& down, Field3& position);

}  // namespace curtain
