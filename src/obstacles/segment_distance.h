// SPDX-License-Identifier: BSD-3-Clause
//
// Closed form of the point of a cloth edge or triangle nearest to a segment on the z axis: the minimum for a capsule,
// or a sphere (a segment of zero length).
#pragma once

#include <array>

#include "obstacles/convex_shape.h"

namespace curtain {

/// Minimum of the distance to a solid whose points are all within `radius` [m, > 0] of the segment from -half to half
/// on z [m, >= 0]; shape: that solid.
void minimiseAroundSegment(const ConvexShape& shape, double radius, double half, const std::array<Vec3, 3>& corners,
                           ElementMinimum& out) noexcept;
void minimiseAroundSegment(const ConvexShape& shape, double radius, double half, const std::array<Vec3, 2>& ends,
                           ElementMinimum& out) noexcept;

}  // namespace curtain
