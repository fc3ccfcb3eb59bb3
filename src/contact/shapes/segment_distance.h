// SPDX-License-Identifier: BSD-3-Clause
//
// The point of a cloth edge or triangle nearest to a segment on the z axis, in closed form: what is inside a capsule,
// or a sphere (a segment without length).
#pragma once

#include <array>

#include "contact/shapes/convex_shape.h"

namespace curtain {

/// The minimum of the distance to a solid that is all within `radius` of the segment from -half to half on z [m, > 0
/// and
/// >= 0]; shape: that solid.
void minimiseAroundSegment(const ConvexShape& shape, double radius, double half, const std::array<Vec3, 3>& corners,
                           ElementMinimum& out) noexcept;
void minimiseAroundSegment(const ConvexShape& shape, double radius, double half, const std::array<Vec3, 2>& ends,
                           ElementMinimum& out) noexcept;

}  // namespace curtain
