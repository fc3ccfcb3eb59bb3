// SPDX-License-Identifier: BSD-3-Clause
//
// Whether messages are what they say. They may come from any node, bag or version: what is wrong is told, never drawn.
#pragma once

#include <string>

#include "curtain_sim/CurtainState.h"
#include "curtain_sim/Loads.h"

namespace curtain_rviz {

/// What is wrong with a state: "field: text"; empty: nothing, and CurtainSurface can draw it. Any thread.
std::string whatIsWrong(const curtain_sim::CurtainState& state);

/// What is wrong with loads, as such or as those of this state; the state must have nothing wrong. Any thread.
std::string whatIsWrong(const curtain_sim::Loads& loads, const curtain_sim::CurtainState& state);

}  // namespace curtain_rviz
