// SPDX-License-Identifier: BSD-3-Clause
//
// Triangles of round solids for drawing: a profile revolved about z, normals outward.
#pragma once

#include <vector>

#include "curtain_sim/obstacle_shape.h"

namespace curtain {

/// (radius, z) [m] from the lower to the upper pole, ends on the axis.
using Profile = std::vector<Eigen::Vector2d>;

/// Quarter circle around (0, centre), counter-clockwise from angle `from` [rad, 0 = equator], ends included.
void appendArc(double radius, double centre, double from, Profile& profile);

ShapeTriangles turnAboutZ(const Profile& profile);

}  // namespace curtain
