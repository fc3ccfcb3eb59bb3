// SPDX-License-Identifier: BSD-3-Clause
#include "ros/health/health_checks.h"

#include <algorithm>

namespace curtain_ros {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

namespace {

constexpr double kLately = 5.0;     // [s]
constexpr double kStill = 5.0;      // [s] without a frame, beyond a frame's own time
constexpr double kTooSlow = 0.95;   // of the clock
constexpr double kRounding = 1e-9;  // of a relative length that was settled to just the tolerance

// Adds a count to the values, and a warning when it has risen lately.
class Counts {
 public:
  Counts(DiagnosticStatusWrapper& status, Rises& rises, const Pulse& pulse)
      : status_(status), rises_(rises), now_(pulse.now) {}

  template <typename Count>
  void add(const std::string& what, Count count, unsigned char level = DiagnosticStatus::WARN) {
    status_.add(what, count);
    if (rises_.lately(what, static_cast<double>(count), now_)) status_.mergeSummary(level, what);
  }

 private:
  DiagnosticStatusWrapper& status_;
  Rises& rises_;
  ros::SteadyTime now_;
};

void checkPulse(const Health& health, const Pulse& pulse, DiagnosticStatusWrapper& status) {
  if (pulse.last_frame.isZero()) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        pulse.clock_simulated ? "no frame yet: /clock does not run" : "no frame yet");
    return;
  }
  const double still = (pulse.now - pulse.last_frame).toSec();
  status.add("seconds since the last frame", still);
  if (still < kStill + 1.0 / health.frame_rate) return;
  if (pulse.clock_simulated && pulse.clock_stands) {
    status.mergeSummary(DiagnosticStatus::OK, "/clock stands");
  } else {
    status.mergeSummary(DiagnosticStatus::ERROR, "no frame for " + std::to_string(static_cast<long>(still)) + " s");
  }
}

}  // namespace

bool Rises::lately(const std::string& name, double count, const ros::SteadyTime& now) {
  Seen& seen = seen_[name];
  if (count > seen.count) seen.rose = now;
  seen.count = count;
  return !seen.rose.isZero() && (now - seen.rose).toSec() < kLately;
}

void checkSimulation(const Health& health, const Pulse& pulse, Rises& rises, DiagnosticStatusWrapper& status) {
  const curtain_sim::Statistics& s = health.statistics;
  status.summary(DiagnosticStatus::OK, "");
  Counts counts(status, rises, pulse);
  counts.add("state not finite", s.not_finite, DiagnosticStatus::ERROR);
  checkPulse(health, pulse, status);
  const double stretch = std::max(s.warp_stretch, s.weft_stretch);
  if (stretch > health.stretch_tolerance * (1.0 + kRounding)) {
    status.mergeSummary(DiagnosticStatus::WARN, "links longer than stretch_tolerance");
  }
  if (!pulse.clock_simulated && s.real_time_factor > 0.0 && s.real_time_factor < kTooSlow) {
    status.mergeSummary(DiagnosticStatus::WARN, "slower than the clock");
  }
  counts.add("substeps stopped", s.stops);
  counts.add("substeps unsettled", s.unsettled);
  counts.add("substeps of the last resort", s.last_resort_substeps);
  counts.add("frames dropped", s.dropped_frames);
  counts.add("frames over budget", s.late_frames);
  counts.add("frames shortened", s.shortened_frames);
  counts.add("clock jumped back", s.clock_jumps_back);
  counts.add("computer's clock set back", s.clock_set_back);
  status.add("frame", s.frame);
  status.add("simulated time", s.simulated_time);
  status.add("real time factor", s.real_time_factor);
  status.add("step ms", s.step_ms);
  status.add("step ms max", s.step_ms_max);
  status.add("largest stretch", stretch);
  status.add("stretch tolerance", health.stretch_tolerance);
  status.add("columns asleep", s.asleep);
  status.add("restarts", s.restarts);
  if (status.message.empty()) status.message = "runs";
}

void checkInputs(const Health& health, const Pulse& pulse, Rises& rises, DiagnosticStatusWrapper& status) {
  const curtain_sim::Statistics& s = health.statistics;
  status.summary(DiagnosticStatus::OK, "");
  Counts counts(status, rises, pulse);
  status.add("messages taken", s.messages_taken);
  counts.add("messages with bad values", s.dropped_invalid);
  counts.add("messages in unknown frames", s.dropped_untransformed);
  counts.add("messages too many for a frame", s.dropped_overflow);
  counts.add("messages dropped by roscpp", s.dropped_queue);
  if (!health.last_drop.empty()) status.add("last dropped", health.last_drop);
  if (status.message.empty()) status.message = "no message dropped lately";
}

void checkObstacles(const Health& health, const Pulse& pulse, Rises& rises, DiagnosticStatusWrapper& status) {
  const curtain_sim::Statistics& s = health.statistics;
  status.summary(DiagnosticStatus::OK, "");
  for (const ObstacleHealth& obstacle : health.obstacles) {
    std::string how = obstacle.is_static ? "static" : std::to_string(obstacle.age) + " s old";
    if (!obstacle.present) {
      how = "left out: " + (!obstacle.error.empty() ? obstacle.error : obstacle.age > 0.0 ? how : "not looked for yet");
      status.mergeSummary(DiagnosticStatus::WARN, "'" + obstacle.name + "' is left out");
    } else if (obstacle.early) {
      status.mergeSummary(DiagnosticStatus::WARN, "'" + obstacle.frame + "' is ahead of the clock");
    } else if (obstacle.late) {
      status.mergeSummary(DiagnosticStatus::WARN, "'" + obstacle.frame + "' is late");
    }
    status.add(obstacle.name + " on " + obstacle.frame, how);
  }
  if (!health.viewer_error.empty()) {
    status.mergeSummary(DiagnosticStatus::WARN, "the frame of mesh_viewer_frame is not known");
    status.add("mesh_viewer_frame", health.viewer_error);
  }
  Counts counts(status, rises, pulse);
  counts.add("poses late", s.late_poses);
  counts.add("poses ahead of the clock", s.early_poses);
  counts.add("obstacles lost", s.obstacles_lost);
  if (status.message.empty()) {
    const std::size_t count = health.obstacles.size();
    status.message = count == 0 ? "none on tf2 frames" : "all " + std::to_string(count) + " there";
  }
}

void checkSnapshots(const Health& health, const Pulse& pulse, Rises& rises, DiagnosticStatusWrapper& status) {
  const SnapshotHealth& s = health.snapshots;
  status.summary(DiagnosticStatus::OK, "");
  if (s.foreign) status.mergeSummary(DiagnosticStatus::WARN, "none is written: there is another file");
  if (!s.last_failure.empty()) status.mergeSummary(DiagnosticStatus::WARN, "the last one was not written");
  if (rises.lately("refused", s.refused.empty() ? 0.0 : 1.0, pulse.now)) {
    status.mergeSummary(DiagnosticStatus::WARN, "not restored");
  }
  Counts(status, rises, pulse).add("replaced before written", s.replaced);
  status.add("written", s.written);
  status.add("failed", s.failed);
  status.add("restored at", s.restored_time);
  if (!s.last_failure.empty()) status.add("last failure", s.last_failure);
  if (!s.refused.empty()) status.add("refused", s.refused);
  if (status.message.empty()) status.message = s.wanted ? "as they should be" : "off";
}

void checkMaster(const Health& health, const Pulse& pulse, Rises& rises, DiagnosticStatusWrapper& status) {
  status.summary(DiagnosticStatus::OK, "");
  if (!health.master_answers) status.mergeSummary(DiagnosticStatus::WARN, "does not answer");
  Counts(status, rises, pulse).add("had forgotten the node", health.statistics.masters_lost);
  if (status.message.empty()) status.message = health.master_watched ? "knows the node" : "not watched";
}

}  // namespace curtain_ros
