// SPDX-License-Identifier: BSD-3-Clause
//
// How flat cloth that narrows towards its hem starts: as a fan. Its columns are straight, and lean towards the middle
// by their share of what the hem is narrower:
//
//     from _____________ to     share c in [-1/2, 1/2], with sin(lean) = c (span - hem) / height
//          \   \ | /   /
//           \   \|/   /         The rods are equally long, so that the outer ends of a row are higher than its middle,
//            '--.|.--'          and its wefts need length for that: the hem starts narrower than its own weft.
#pragma once

#include <optional>

#include "curtain_sim/scene.h"

namespace curtain {

/// Width that the hem of flat cloth starts with where the hung edge is as wide as `span` [m]: the largest that no weft
/// is too long with, and no more than span. Empty: there is none. Immutable: any number of threads may call it.
std::optional<double> startingHem(const Scene& scene, double span);

}  // namespace curtain
