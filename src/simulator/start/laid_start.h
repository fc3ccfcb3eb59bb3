// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that begins laid over an obstacle: where it comes to rest when it falls on it, flat and level, from just above.
#pragma once

#include <vector>

#include "curtain_sim/simulator.h"
#include "obstacles/obstacle_set.h"

namespace curtain {

/// The scene in which it comes to rest: the cloth above the obstacle of this number, all obstacles where they are at
/// the start, and nothing else moves.
Scene settlingScene(const Scene& scene, const ObstacleSet& obstacles, int number);

/// Positions [m] of the nodes where it is at rest, row by row. resting: a simulator of settlingScene().
std::vector<Vec3> layOver(Simulator& resting);

}  // namespace curtain
