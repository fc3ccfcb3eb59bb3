// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: obstacles follow their tf2 frames. Each frame of the simulation takes what tf2 knows last and never waits:
//
//   frame known, fresh     the obstacle moves there during the step (that is its velocity)
//   frame late             it stays at its last pose
//   later than the timeout it is left out, with a warning, until the frame is back; then it is there at once
//   ahead of the clock by  it is where tf2 knows the frame to be now, between an older transform and that one; where
//   tf2
//     more than the timeout  can't tell, the frame is late
//   never seen             it is left out
//   static frame           never late
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "ros/frames/frames.h"

namespace curtain_ros {

/// How an obstacle stands with its frame.
struct ObstacleHealth {
  std::string name;
  std::string frame;
  bool present = false;
  bool is_static = false;
  bool late = false;   ///< its transform is older than half of the timeout
  bool early = false;  ///< its transform is ahead of the clock by more than the timeout
  double age = 0.0;    ///< of its transform [s]; of the last one while the frame is not known
  std::string error;   ///< why its frame is not known; empty: it is
};

/// Simulation thread only.
class ObstacleTracker {
 public:
  /// Starts listening to tf2 when an obstacle needs it. frames must outlive this.
  ///   timeout  [s], > 0
  ObstacleTracker(const curtain::Scene& scene, double timeout, Frames& frames);

  /// The obstacles as they are at the start of a run: those on tf2 frames absent until their frame is known.
  void restart(curtain::Simulator& simulator);

  /// The obstacles as a snapshot left them: those that were there stay at their poses until their frame is known, as if
  /// it were late since now, and then are there at once.
  void resume(const curtain::Simulator& simulator);

  /// To be called before each step. now  of the node's clock, which the transforms' stamps are compared with.
  void update(curtain::Simulator& simulator, const ros::Time& now);

  /// Obstacles left out now.
  std::uint32_t absent() const;

  /// Since construction: poses taken, one an obstacle and frame, that were older than half of the timeout …
  std::uint64_t latePoses() const { return late_poses_; }
  /// … and ahead of the clock by more than it.
  std::uint64_t earlyPoses() const { return early_poses_; }
  /// Times that an obstacle was left out that had been there.
  std::uint32_t lost() const { return lost_; }

  /// Of the obstacles on tf2 frames, in the scene's order.
  std::vector<ObstacleHealth> health() const;

 private:
  struct Tracked {
    int index = 0;         // in the simulator
    curtain::Pose offset;  // in its frame
    ros::Time stamp;       // of the last transform
    bool resumed = false;  // from a snapshot, and its frame not known since
    ObstacleHealth health;
  };

  FrameLookup look(Tracked& obstacle, const ros::Time& now);
  /// Returns why it is left out; empty: it is not, or it is too early to tell.
  std::string follow(Tracked& obstacle, curtain::Simulator& simulator, const ros::Time& now);
  void leaveOut(Tracked& obstacle, curtain::Simulator& simulator);

  double timeout_;
  Frames& frames_;
  std::vector<Tracked> tracked_;
  std::uint64_t late_poses_ = 0;
  std::uint64_t early_poses_ = 0;
  std::uint32_t lost_ = 0;
};

}  // namespace curtain_ros
