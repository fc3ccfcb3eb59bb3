// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that begins laid over an obstacle: where it comes to rest when it falls on it, flat and level, from just above.
#pragma once

#include "curtain_sim/simulator.h"

namespace curtain {

/// Positions [m] of the nodes, row by row. resting: a simulator of settlingScene().
std::vector<Vec3> layOver(Simulator& resting);

/// The scene in which it comes to rest: the cloth above the obstacle of hang.start.over, whose box at its start this is
/// [m], and nothing else moves.
Scene settlingScene(const Scene& scene, const Eigen::AlignedBox3d& box);

}  // namespace curtain
