// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that begins laid over an obstacle: where it comes to rest when it falls on it, flat and level, from just above.
// Several cloths fall one above the other, in their order.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cloth/cloth.h"
#include "curtain_sim/simulator.h"
#include "obstacles/obstacle_set.h"

namespace curtain {

/// A cloth (Layers) and the obstacle that it is laid over.
struct Laid {
  std::size_t layer;
  int obstacle;
  std::string key;  ///< of hang.start.over
};

/// What is wrong with how several cloths that touch begin; empty: nothing, or there is one.
std::string problemOfLayers(const Scene& scene, const ClothPattern& pattern, const Field3& position);

/// All cloths of a validated scene that are laid over something.
std::vector<Laid> laidCloths(const Scene& scene);

/// The scene in which they come to rest: these cloths above their obstacles, others beside them, all obstacles where
/// they are at the start.
Scene settlingScene(const Scene& scene, const ObstacleSet& obstacles, const std::vector<Laid>& laid);

/// Positions [m] of all nodes where they are at rest, row by row. resting: a simulator of settlingScene().
std::vector<Vec3> settle(Simulator& resting);

}  // namespace curtain
