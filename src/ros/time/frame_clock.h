// SPDX-License-Identifier: BSD-3-Clause
//
// The time that frames follow. Under use_sim_time that is /clock. Otherwise the monotonic clock paces the frames, so
// that setting the computer's clock does not reset the curtain, and they are stamped with ROS time.
#pragma once

#include <ros/time.h>

#include <chrono>
#include <cstdint>

#include "curtain_sim/Statistics.h"
#include "ros/time/stamp_keeper.h"
#include "ros/time/step_clock.h"

namespace curtain_ros {

/// Simulation thread only.
class FrameClock {
 public:
  /// As of StepClock.
  FrameClock(double frame_rate, int max_catch_up)
      : simulated_(ros::Time::isSimTime()), frame_rate_(frame_rate), steps_(frame_rate, max_catch_up) {}

  bool simulated() const { return simulated_; }

  /// [ns]; 0: no /clock yet.
  std::int64_t now() const { return simulated_ ? nanoseconds(ros::Time::now()) : nanoseconds(ros::SteadyTime::now()); }

  /// Frames that are due; warns about a clock that jumped back.
  StepClock::Due update(std::int64_t now);

  /// Takes the next frame that is due; its stamp. Stamps rise, unless /clock jumped back.
  ros::Time take();

  /// Until the next frame is due; a /clock that others drive is polled.
  std::chrono::nanoseconds untilNext() const;

  /// Warns about frames dropped and clocks set back since the last call. step_seconds  [s] that a frame takes
  void logLosses(double step_seconds);

  void count(curtain_sim::Statistics& statistics) const;

 private:
  template <typename Time>
  static std::int64_t nanoseconds(const Time& time) {
    return static_cast<std::int64_t>(time.toNSec());
  }

  void measureSpeed();

  bool simulated_;
  double frame_rate_;
  StepClock steps_;
  StampKeeper stamps_;
  std::uint32_t jumps_back_ = 0;
  std::uint64_t logged_dropped_ = 0;
  std::uint32_t logged_set_back_ = 0;
  // Frames and their start on the monotonic clock, of the second that is measured now.
  std::int64_t measured_frames_ = 0;
  ros::SteadyTime measured_since_ = ros::SteadyTime::now();
  double real_time_factor_ = 0.0;
};

}  // namespace curtain_ros
