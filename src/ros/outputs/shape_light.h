// SPDX-License-Identifier: BSD-3-Clause
//
// Light on obstacles, in the colours of their triangles' corners. Rviz would light triangles flat, from where the
// viewer is; so round shapes would show their facets, and boxes their nearest side alone.
#pragma once

#include <std_msgs/ColorRGBA.h>

#include "curtain_sim/scene.h"

namespace curtain_ros {

/// Colour of a surface in the light.
///   base    red, green, blue [0..1]
///   normal  outward, unit length, world frame, z up
std_msgs::ColorRGBA litColour(const curtain::Vec3& base, const curtain::Vec3& normal);

}  // namespace curtain_ros
