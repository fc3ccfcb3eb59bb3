// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: obstacles follow their tf2 frames. Each frame of the simulation takes what tf2 knows last and never waits:
//
//   frame known, fresh     the obstacle moves there during the step (that is its velocity)
//   frame late             it stays at its last pose
//   later than the timeout it is left out, with a warning, until the frame is back; then it is there at once
//   never seen             it is left out
//   static frame           never late
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "ros/frames.h"

namespace curtain_ros {

/// Simulation thread only.
class ObstacleTracker {
 public:
  /// Starts listening to tf2 when an obstacle needs it. frames must outlive this.
  ///   timeout  [s], > 0
  ObstacleTracker(const curtain::Scene& scene, double timeout, Frames& frames);

  /// The obstacles as they are at the start of a run: those on tf2 frames absent until their frame is known.
  void restart(curtain::Simulator& simulator);

  /// To be called before each step. now  of the node's clock, which the transforms' stamps are compared with.
  void update(curtain::Simulator& simulator, const ros::Time& now);

  /// Obstacles left out now.
  std::uint32_t absent() const;

 private:
  struct Tracked {
    int index = 0;  // in the simulator
    std::string name;
    std::string frame;
    curtain::Pose offset;  // in its frame
    bool present = false;
    bool is_static = false;
    ros::Time stamp;  // of the last transform
  };

  void follow(Tracked& obstacle, curtain::Simulator& simulator, const ros::Time& now);

  double timeout_;
  Frames& frames_;
  std::vector<Tracked> tracked_;
};

}  // namespace curtain_ros
