// SPDX-License-Identifier: BSD-3-Clause
//
// Where the cloth is in a substep, and how fast: a box in the world.
#pragma once

#include <Eigen/Geometry>

#include "cloth/cloth.h"

namespace curtain {

/// How a cloth moves from start to predicted.
struct ClothMotion {
  Eigen::AlignedBox3d box;  ///< around both [m]
  double move = 0.0;        ///< of the node that moves most [m]
};
ClothMotion motionOfCloth(const Grid& grid, const Field3& start, const Field3& predicted) noexcept;

}  // namespace curtain
