// SPDX-License-Identifier: BSD-3-Clause
//
// Gathered cloth without slack, for engines whose links resist shortening.
#pragma once

#include "bench/contestant.h"

namespace curtain_bench {

/// The start of gathered cloth that hangs along x, with each row in five waves along y of links of their lengths.
ClothStart inWaves(ClothStart start);

}  // namespace curtain_bench
