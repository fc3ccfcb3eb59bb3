// SPDX-License-Identifier: BSD-3-Clause
//
// Where the cloth can be at all, and where it can be for the next frames: boxes in the world.
#pragma once

#include <Eigen/Geometry>

#include "cloth/cloth.h"

namespace curtain {

/// Box around all places that the cloth can ever reach: no node gets further from a pinned one than the links between them are
/// long. Unbounded without pinned nodes. position: the pinned nodes' at least [m]. O(nodes) a pass, a few passes.
Eigen::AlignedBox3d reachOfCloth(const ClothPattern& pattern, const Field3& position);

/// How a cloth moves from start to predicted.
struct ClothMotion {
  Eigen::AlignedBox3d box;  ///< around both [m]
  double move = 0.0;        ///< of the node that moves most [m]
};
ClothMotion motionOfCloth(const Grid& grid, const Field3& start, const Field3& predicted) noexcept;

}  // namespace curtain
