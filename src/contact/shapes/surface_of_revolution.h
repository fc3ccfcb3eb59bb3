// SPDX-License-Identifier: BSD-3-Clause
//
// Triangles of round solids for drawing: a profile turned about z, fine enough to look round at the size of a window,
// wound so that their normals point outward.
#pragma once

#include <vector>

#include "curtain_sim/obstacle_shape.h"

namespace curtain {

/// (radius, z) [m] from the lower to the upper pole, ends on the axis.
using Profile = std::vector<Eigen::Vector2d>;

/// Quarter circle around (0, centre) from angle `from` [rad, 0 = equator] to a quarter turn further, ends included.
void appendArc(double radius, double centre, double from, Profile& profile);

ShapeTriangles turnAboutZ(const Profile& profile);

}  // namespace curtain
