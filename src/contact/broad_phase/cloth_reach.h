// SPDX-License-Identifier: BSD-3-Clause
//
// Where the cloth is in a substep: a box in the world.
#pragma once

#include <Eigen/Geometry>

#include "cloth/cloth.h"

namespace curtain {

/// Around all nodes, at both.
Eigen::AlignedBox3d boxAround(const Grid& grid, const Field3& start, const Field3& end) noexcept;

}  // namespace curtain
