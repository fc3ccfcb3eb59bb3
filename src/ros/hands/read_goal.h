// SPDX-License-Identifier: BSD-3-Clause
//
// Goals of ~grasp as the engine's grasps, checked on the way. Needs no ROS master.
#pragma once

#include <curtain_sim/GraspGoal.h>

#include <string>
#include <vector>

#include "curtain_sim/grasp.h"

namespace curtain_ros {

/// Everything of the goal but its frame. Simulator::setGrasp() checks what needs the cloth.
///   id     of the grasp
///   grasp  out: valid when no problem is returned
std::vector<curtain::Problem> toGrasp(const curtain_sim::GraspGoal& goal, const std::string& id,
                                      const curtain::ClothParams& cloth, curtain::GraspParams& grasp);

}  // namespace curtain_ros
