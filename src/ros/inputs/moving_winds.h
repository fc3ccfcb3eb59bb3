// SPDX-License-Identifier: BSD-3-Clause
//
// Winds that move with their tf2 frames (WindSource.moves_with_frame): a fan on a robot, a drone. Before each frame of
// the simulation they are put where their frames are then; one whose frame is not known stays where it was.
#pragma once

#include <map>
#include <string>

#include "curtain_sim/WindSource.h"
#include "curtain_sim/simulator.h"
#include "ros/frames/frames.h"

namespace curtain_ros {

/// Simulation thread only.
class MovingWinds {
 public:
  /// A message was taken that adds, replaces or deletes a source.
  void note(const curtain_sim::WindSource& message);
  /// A new run begins: the simulator has forgotten the messages' sources.
  void clear() { carried_.clear(); }

  /// Moves the sources, and forgets those that the simulator has no more.
  void update(Frames& frames, curtain::Simulator& simulator);

 private:
  std::map<std::string, curtain_sim::WindSource> carried_;  // by id
};

}  // namespace curtain_ros
