// SPDX-License-Identifier: BSD-3-Clause
//
// Obstacles follow their tf2 frames (Frames::follow()). Each frame of the simulation never waits:
//
//   fresh                      the obstacle moves there during the step, which gives its velocity
//   late                       it stays at its last pose
//   older than the timeout     it is left out, with a warning, until the frame is back; then it jumps there
//   ahead of the clock by more it takes the pose of now, interpolated between an older transform and that one; with
//     than the timeout           no older one the frame is late
//   never seen                 it is left out
//   static frame               never late
//
// Several obstacles on one frame, as those of a robot's link, are one lookup.
#pragma once

#include <ros/time.h>

#include <cstdint>
#include <string>
#include <vector>

#include "curtain_sim/Statistics.h"
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
  double lag = 0.0;    ///< how far it is behind its frame [m]; Simulator::obstacleLag()
};

/// Simulation thread only.
class ObstacleTracker {
 public:
  /// Starts listening to tf2 when an obstacle needs it. frames must outlive this.
  ///   timeout  [s], > 0
  ObstacleTracker(const curtain::Scene& scene, double timeout, Frames& frames);

  /// A new run begins: obstacles on tf2 frames are absent until their frame is known.
  void restart(curtain::Simulator& simulator);

  /// A run goes on from a snapshot: obstacles that were present stay at their poses until their frame is known, for the
  /// timeout at most, and then jump there.
  void resume(const curtain::Simulator& simulator);

  /// timeout  [s], > 0, from now on
  void setTimeout(double timeout) { timeout_ = timeout; }

  /// To be called before each step. now  of the node's clock, which the transforms' stamps are compared with.
  void update(curtain::Simulator& simulator, const ros::Time& now);

  /// Obstacles left out now; since construction poses taken late and ahead of the clock, and obstacles lost.
  void count(curtain_sim::Statistics& statistics) const;

  /// Of the obstacles on tf2 frames, in the scene's order, after a step.
  std::vector<ObstacleHealth> health(const curtain::Simulator& simulator) const;

 private:
  struct Tracked {
    int index = 0;          // in the simulator
    curtain::Pose offset;   // in its frame
    std::string name;       // its own
    std::size_t frame = 0;  // in followed_
  };
  struct Followed {
    std::vector<std::size_t> obstacles;  // on this frame, in tracked_
    std::string names;                   // of these, for messages
    ros::Time stamp;                     // of the last transform
    ros::Time read;                      // of the pose
    bool resumed = false;                // from a snapshot, and the frame not known since
    ObstacleHealth health;               // of each of them, but for its name
  };

  std::size_t placeOf(const std::string& frame);
  void setPresent(Followed& frame, bool present, curtain::Simulator& simulator) const;
  FrameLookup lookUp(Followed& frame, const Following& by);
  /// Returns why its obstacles are left out; empty: they are not, or it is too early to tell.
  std::string follow(Followed& frame, curtain::Simulator& simulator, const ros::Time& now);

  double timeout_;
  Frames& frames_;
  std::vector<Tracked> tracked_;    // in the scene's order
  std::vector<Followed> followed_;  // their frames
  std::uint64_t late_poses_ = 0;
  std::uint64_t early_poses_ = 0;
  std::uint32_t lost_ = 0;
};

}  // namespace curtain_ros
