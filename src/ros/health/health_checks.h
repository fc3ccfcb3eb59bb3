// SPDX-License-Identifier: BSD-3-Clause
//
// When the node is well, and when it is not. One check for each status on /diagnostics:
//
//   simulation  ERROR  the state was not finite; no frame for 5 s although the clock runs and nobody paused the node
//               WARN   no frame yet (a /clock that stops later is OK); links longer than the scene's tolerance;
//                      slower than 0.95 of the clock; lately: substeps unsettled, of the last resort or stopped,
//                      frames dropped, late or shortened, /clock jumped back, the computer's clock set back
//   inputs      WARN   lately: messages refused, in unknown frames, too many for a frame, dropped in roscpp's queue
//   obstacles   WARN   one left out, late (half of ~obstacle_timeout), ahead of the clock, or behind its frame; no
//                      viewer's frame; a sensor that sees nothing; lately: one waited for jammed cloth
//   snapshots   WARN   the last one was not written, or the file is no snapshot; lately: one replaced before it was
//                      written, or the file refused at the start
//   master      WARN   it does not answer; lately: it had forgotten the node. Without ~watch_roscpp always OK
//
// "Lately" is five seconds: long enough for a person to see. Counts stand among the values.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/time.h>

#include <map>
#include <string>
#include <vector>

#include "curtain_sim/Statistics.h"
#include "ros/obstacles/obstacle_tracker.h"
#include "ros/snapshots/snapshot_keeper.h"

namespace curtain_ros {

/// How the node is, at one moment.
struct Health {
  curtain_sim::Statistics statistics;
  double stretch_tolerance = 0.0;  ///< of the scene, relative
  double frame_rate = 0.0;         ///< [1/s]
  bool paused = false;             ///< by ~pause: frames come by ~step alone
  std::vector<ObstacleHealth> obstacles;
  SnapshotHealth snapshots;
  std::string last_drop;       ///< which message was dropped last, and why; empty: none
  std::string viewer_error;    ///< why the frame of ~mesh's viewer is not known; empty: it is, or none is asked for
  std::string sensor_error;    ///< why ~points sees nothing; empty: it does, or nobody listens
  bool master_watched = true;  ///< ~watch_roscpp
  bool master_answers = true;
};

/// Tells when a count has last risen. One thread at a time.
class Rises {
 public:
  /// Whether the count rose since the last call, or at an earlier one lately. Counts begin at 0; one that falls begins
  /// again.
  bool lately(const std::string& name, double count, const ros::SteadyTime& now);

 private:
  struct Seen {
    double count = 0.0;
    ros::SteadyTime rose;  // zero: never
  };
  std::map<std::string, Seen> seen_;
};

/// The moment of a check.
struct Pulse {
  ros::SteadyTime now;
  ros::SteadyTime last_frame;    ///< zero: none yet
  bool clock_simulated = false;  ///< /clock may stand as long as it likes
  bool clock_stands = false;     ///< and has not moved since the last check
};

using Check = void(const Health&, const Pulse&, Rises&, diagnostic_updater::DiagnosticStatusWrapper&);
Check checkSimulation, checkInputs, checkObstacles, checkSnapshots, checkMaster;

}  // namespace curtain_ros
