// SPDX-License-Identifier: BSD-3-Clause
#include "ros/health/health_checks.h"

#include <algorithm>

#include "curtain_sim/statistics.h"

namespace curtain_ros {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

namespace {

constexpr double kLately = 5.0;     // [s]
constexpr double kStill = 5.0;      // [s] without a frame, beyond a frame's own time
constexpr double kTooSlow = 0.95;   // of the clock
constexpr double kRounding = 1e-9;  // of a relative length that was settled to just the tolerance

// A status that is OK until something is wrong.
class Report {
 public:
  Report(DiagnosticStatusWrapper& status, Rises& rises, const Pulse& pulse)
      : status_(status), rises_(rises), now_(pulse.now) {
    status_.summary(DiagnosticStatus::OK, "");
  }

  template <typename Value>
  void value(const std::string& what, const Value& value) {
    status_.add(what, value);
  }

  /// A value that is a warning when it has risen lately.
  template <typename Count>
  void count(const std::string& what, Count count, unsigned char level = DiagnosticStatus::WARN) {
    status_.add(what, count);
    tellIf(rises_.lately(what, static_cast<double>(count), now_), what, level);
  }

  void tellIf(bool yes, const std::string& what, unsigned char level = DiagnosticStatus::WARN) {
    if (yes) status_.mergeSummary(level, what);
  }

  /// The message when there is no other.
  void otherwise(const std::string& message) {
    if (status_.message.empty()) status_.message = message;
  }

 private:
  DiagnosticStatusWrapper& status_;
  Rises& rises_;
  ros::SteadyTime now_;
};

void checkPulse(const Health& health, const Pulse& pulse, Report& report) {
  if (health.paused) return;
  if (pulse.last_frame.isZero()) {
    report.tellIf(true, pulse.clock_simulated ? "no frame yet: /clock does not run" : "no frame yet");
    return;
  }
  const double still = (pulse.now - pulse.last_frame).toSec();
  report.value("seconds since the last frame", still);
  if (still < kStill + 1.0 / health.frame_rate) return;
  const bool clock_stands = pulse.clock_simulated && pulse.clock_stands;
  report.tellIf(clock_stands, "/clock stands", DiagnosticStatus::OK);
  report.tellIf(!clock_stands, "no frame for " + std::to_string(static_cast<long>(still)) + " s",
                DiagnosticStatus::ERROR);
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
  Report report(status, rises, pulse);
  report.count("state not finite", s.not_finite, DiagnosticStatus::ERROR);
  checkPulse(health, pulse, report);
  const double stretch = std::max(s.warp_stretch, s.weft_stretch);
  report.tellIf(stretch > health.stretch_tolerance * (1.0 + kRounding), "links longer than stretch_tolerance");
  report.tellIf(!pulse.clock_simulated && !health.paused && s.real_time_factor > 0.0 && s.real_time_factor < kTooSlow,
                "slower than the clock");
  report.count("substeps stopped", s.stops);
  report.count("substeps unsettled", s.unsettled);
  report.count("substeps of the last resort", s.last_resort_substeps);
  report.count("frames dropped", s.dropped_frames);
  report.count("frames over budget", s.late_frames);
  report.count("frames shortened", s.shortened_frames);
  report.count("clock jumped back", s.clock_jumps_back);
  report.count("computer's clock set back", s.clock_set_back);
  report.value("frame", s.frame);
  report.value("simulated time", s.simulated_time);
  report.value("real time factor", s.real_time_factor);
  report.value("step ms", s.step_ms);
  report.value("step ms max", s.step_ms_max);
  report.value("largest stretch", stretch);
  report.value("stretch tolerance", health.stretch_tolerance);
  report.value("asleep", s.asleep ? "yes" : "no");
  report.value("quality of the last frame", curtain::toString(static_cast<curtain::FrameQuality>(s.quality)));
  report.value("stops in the last frame", s.stops_last);
  report.value("restarts", s.restarts);
  report.otherwise(health.paused ? "paused" : "runs");
}

void checkInputs(const Health& health, const Pulse& pulse, Rises& rises, DiagnosticStatusWrapper& status) {
  const curtain_sim::Statistics& s = health.statistics;
  Report report(status, rises, pulse);
  report.value("messages taken", s.messages_taken);
  report.count("messages with bad values", s.dropped_invalid);
  report.count("messages in unknown frames", s.dropped_untransformed);
  report.count("messages too many for a frame", s.dropped_overflow);
  report.count("messages dropped by roscpp", s.dropped_queue);
  if (!health.last_drop.empty()) report.value("last dropped", health.last_drop);
  report.otherwise("no message dropped lately");
}

void checkObstacles(const Health& health, const Pulse& pulse, Rises& rises, DiagnosticStatusWrapper& status) {
  const curtain_sim::Statistics& s = health.statistics;
  Report report(status, rises, pulse);
  for (const ObstacleHealth& o : health.obstacles) {
    std::string how = o.is_static ? "static" : std::to_string(o.age) + " s old";
    if (!o.present) how = "left out: " + (!o.error.empty() ? o.error : o.age > 0.0 ? how : "not looked for yet");
    report.tellIf(!o.present, "'" + o.name + "' is left out");
    report.tellIf(o.present && o.early, "'" + o.frame + "' is ahead of the clock");
    report.tellIf(o.present && o.late, "'" + o.frame + "' is late");
    if (o.present && o.lag > 0.0) {
      const std::string waits = "waits " + std::to_string(o.lag) + " m behind";
      report.tellIf(true, "'" + o.name + "' " + waits + " '" + o.frame + "'");
      how += ", " + waits;
    }
    report.value(o.name + " on " + o.frame, how);
  }
  report.tellIf(!health.viewer_error.empty(), "the frame of mesh_viewer_frame is not known");
  if (!health.viewer_error.empty()) report.value("mesh_viewer_frame", health.viewer_error);
  report.tellIf(!health.sensor_error.empty(), "~points sees nothing");
  if (!health.sensor_error.empty()) report.value("points", health.sensor_error);
  report.count("poses late", s.late_poses);
  report.count("poses ahead of the clock", s.early_poses);
  report.count("obstacles lost", s.obstacles_lost);
  report.count("seconds waited for cloth", s.obstacles_waited);
  const std::size_t count = health.obstacles.size();
  report.otherwise(count == 0 ? "none on tf2 frames" : "all " + std::to_string(count) + " there");
}

void checkSnapshots(const Health& health, const Pulse& pulse, Rises& rises, DiagnosticStatusWrapper& status) {
  const SnapshotHealth& s = health.snapshots;
  Report report(status, rises, pulse);
  report.tellIf(s.foreign, "none is written: there is another file");
  report.tellIf(!s.last_failure.empty(), "the last one was not written");
  report.tellIf(rises.lately("refused", s.refused.empty() ? 0.0 : 1.0, pulse.now), "not restored");
  report.count("replaced before written", s.replaced);
  report.value("written", s.written);
  report.value("failed", s.failed);
  report.value("restored at", s.restored_time);
  if (!s.last_failure.empty()) report.value("last failure", s.last_failure);
  if (!s.refused.empty()) report.value("refused", s.refused);
  report.otherwise(s.wanted ? "as they should be" : "off");
}

void checkMaster(const Health& health, const Pulse& pulse, Rises& rises, DiagnosticStatusWrapper& status) {
  Report report(status, rises, pulse);
  report.tellIf(!health.master_answers, "does not answer");
  report.count("had forgotten the node", health.statistics.masters_lost);
  report.otherwise(health.master_watched ? "knows the node" : "not watched");
}

}  // namespace curtain_ros
