// SPDX-License-Identifier: BSD-3-Clause
//
// What may be changed while the node runs, as dynamic_reconfigure has it (cfg/Curtain.cfg) and as the node does.
#pragma once

#include <string>
#include <vector>

#include "curtain_sim/CurtainConfig.h"
#include "curtain_sim/SetMaterial.h"
#include "curtain_sim/simulator.h"
#include "ros/parameters/parameters.h"

namespace curtain_ros {

/// The present values.
curtain_sim::CurtainConfig liveValues(const curtain::Scene& scene, const NodeParams& params);

/// Gives the simulator and the node's parameters these values, judged as the scene's and the parameters' are. Returns
/// what is wrong; those are left as they are, the others are taken. Simulation thread.
std::vector<curtain::Problem> applyLiveValues(const curtain_sim::CurtainConfig& values, curtain::Simulator& simulator,
                                              NodeParams& params);

/// Makes the cloth that is asked for, or a part of it, one of a known fabric (curtain::applyMaterial());
/// contact.thickness stays, and of a layer or a part friction and air. Returns what is wrong with it: a name that is
/// none, no such part, or a method that knows no such cloth; then nothing changed.
std::vector<curtain::Problem> applyMaterial(const curtain_sim::SetMaterialRequest& wanted,
                                            curtain::Simulator& simulator);

}  // namespace curtain_ros
