// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: when the node is well, and when it is not. One check for each status on /diagnostics:
//
//   simulation  ERROR  the state was not finite; frames stand still although the clock runs (5 s without one)
//               WARN   no frame yet (a /clock that stands later is OK); links longer than the scene's tolerance;
//                      lately: substeps unsettled, of the last resort or stopped, frames dropped, late or shortened,
//                      /clock jumped back, the computer's clock set back; slower than 0.95 of the clock
//   inputs      WARN   lately: messages refused, of unknown frames, too many for a frame, dropped in roscpp's queue
//   obstacles   WARN   one left out, late (half of ~obstacle_timeout), or ahead of the clock; the viewer's frame not
//   known snapshots   WARN   the last one was not written, or the file that is there is none; lately: one replaced
//   unwritten, or the
//                      file refused at the start
//   master      WARN   it does not answer; lately: it had forgotten the node
//
// "Lately" is five seconds: long enough for a person to see, short enough to be of now. Counts stand among the values.
#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/time.h>

#include <map>
#include <string>

#include "ros/health/health.h"

namespace curtain_ros {

/// Tells when a count has last risen. One thread at a time.
class Rises {
 public:
  /// Whether it is more than it was at the last call, or was so at one lately. Counts begin at 0, and again with less.
  bool lately(const std::string& name, double count, const ros::SteadyTime& now);

 private:
  struct Seen {
    double count = 0.0;
    ros::SteadyTime rose;  // zero: never
  };
  std::map<std::string, Seen> seen_;
};

/// What the simulation's check knows besides its health.
struct Pulse {
  ros::SteadyTime now;
  ros::SteadyTime last_frame;    ///< zero: none yet
  bool clock_simulated = false;  ///< /clock may stand as long as it likes
  bool clock_stands = false;     ///< and has not moved since the last look
};

void checkSimulation(const Health& health, const Pulse& pulse, Rises& rises,
                     diagnostic_updater::DiagnosticStatusWrapper& status);
void checkInputs(const Health& health, const ros::SteadyTime& now, Rises& rises,
                 diagnostic_updater::DiagnosticStatusWrapper& status);
void checkObstacles(const Health& health, const ros::SteadyTime& now, Rises& rises,
                    diagnostic_updater::DiagnosticStatusWrapper& status);
void checkSnapshots(const Health& health, const ros::SteadyTime& now, Rises& rises,
                    diagnostic_updater::DiagnosticStatusWrapper& status);
void checkMaster(bool answers, std::uint32_t lost, const ros::SteadyTime& now, Rises& rises,
                 diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace curtain_ros
