// SPDX-License-Identifier: BSD-3-Clause
//
// The scenes whose motion is known: a cloth released straight is as many chains side by side as it has columns.
#pragma once

#include "bench/contestant.h"
#include "curtain_sim/scene.h"

namespace curtain_bench {

/// test/scenes/swing.yaml with this many rods a column, released at an angle from the vertical [rad].
curtain::Scene chainScene(int rods, double angle);

/// Where its nodes are after a time [s], from test/truth/traj_N<rods>_A<degrees>.csv. Throws when there is no such row.
Points chainTruth(const ClothStart& start, int degrees, double time);

}  // namespace curtain_bench
