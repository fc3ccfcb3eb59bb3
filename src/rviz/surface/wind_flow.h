// SPDX-License-Identifier: BSD-3-Clause
//
// A wind source as arrows that fly out of its disc, along the rays of its cone, as fast as air of its pressure would:
//
//        |  ->    ->        The disc has a rim. Arrows appear at the disc and vanish at the reach, which is where the
//        |->    ->          cloth is. They are two flat darts through each other, so that they are seen from all sides.
//        |   ->     ->
#pragma once

#include <vector>

#include "curtain_sim/WindSource.h"
#include "curtain_sim/scene.h"

namespace curtain_rviz {

/// A corner of a triangle.
struct FlowVertex {
  curtain::Vec3 position;  ///< [m]
  float alpha;             ///< in [0, 1]
};

/// Adds the triangles of a source, three vertices each.
///   wind     nothing wrong with it (state_check.h)
///   target   where the arrows fly to [m]; at least half a metre
///   seconds  time that has passed; >= 0
void addWindFlow(const curtain_sim::WindSource& wind, const curtain::Vec3& target, double seconds,
                 std::vector<FlowVertex>& out);

}  // namespace curtain_rviz
