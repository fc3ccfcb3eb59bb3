// SPDX-License-Identifier: BSD-3-Clause
//
// The animation of a bag: a curtain's ~state, and the obstacles of its ~markers where those are in it.
#pragma once

#include <string>

#include "export/animation_writer.h"
#include "export/excerpt.h"

namespace curtain {

/// path   of the bag
/// topic  of the states; empty: the only one in the bag
/// Times are those of the states' stamps, from the first state on. Throws std::invalid_argument, naming the bag, where
/// it can't be read, has no states, or holds what is no animation: another cloth on the way, a clock that jumps back, a
/// message that is not what it says. In a build without rosbag it always does.
void playBag(const std::string& path, const std::string& topic, const Excerpt& excerpt, AnimationWriter& writer);

}  // namespace curtain
