// SPDX-License-Identifier: BSD-3-Clause
//
// Where the cloth is in a substep: a box in the world.
#pragma once

#include <Eigen/Geometry>

#include "cloth/cloth.h"

namespace curtain {

struct Range {
  double low, high;
};

/// What all of two arrays are within.
Range rangeOf(const double* a, const double* b, std::size_t count) noexcept;

/// Around all nodes, at both.
Eigen::AlignedBox3d boxAround(const Grid& grid, const Field3& start, const Field3& end) noexcept;

}  // namespace curtain
