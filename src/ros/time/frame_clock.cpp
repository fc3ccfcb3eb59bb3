// SPDX-License-Identifier: BSD-3-Clause
#include "ros/time/frame_clock.h"

#include <ros/console.h>

#include <algorithm>

namespace curtain_ros {

namespace {
constexpr std::chrono::milliseconds kClockPoll(1);
constexpr double kSpeedPeriod = 1.0;  // [s] that the real-time factor is measured over
constexpr double kWarnPeriod = 5.0;   // [s] between warnings of one kind
}  // namespace

StepClock::Due FrameClock::update(std::int64_t now) {
  const StepClock::Due due = steps_.update(now);
  if (due.restarted) {
    ++jumps_back_;
    ROS_WARN("/clock jumped back: the curtain starts again from the scene");
  }
  return due;
}

ros::Time FrameClock::take() {
  measureSpeed();
  std::int64_t time = steps_.take();
  if (!simulated_) {
    const std::int64_t before = nanoseconds(ros::SteadyTime::now());
    const std::int64_t ros_time = nanoseconds(ros::Time::now());
    const std::int64_t after = nanoseconds(ros::SteadyTime::now());
    time = stamps_.stamp(time, {ros_time - before - (after - before) / 2, after - before});
  }
  return ros::Time().fromNSec(static_cast<std::uint64_t>(time));
}

std::chrono::nanoseconds FrameClock::untilNext() const {
  if (simulated_) return kClockPoll;
  return std::chrono::nanoseconds(std::max<std::int64_t>(steps_.next() - now(), 0));
}

void FrameClock::logLosses(double step_seconds) {
  const std::uint64_t dropped = steps_.dropped();
  if (dropped > logged_dropped_) {
    ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "dropped " << dropped - logged_dropped_ << " frames (" << dropped
                                                     << " so far): the node is too slow, a frame takes "
                                                     << 1e3 * step_seconds << " ms");
  }
  logged_dropped_ = dropped;
  if (stamps_.setBack() > logged_set_back_) {
    ROS_WARN("the computer's clock was set back: stamps follow it, the simulation continues");
  }
  logged_set_back_ = stamps_.setBack();
}

void FrameClock::measureSpeed() {
  ++measured_frames_;
  const double wall = (ros::SteadyTime::now() - measured_since_).toSec();
  if (wall < kSpeedPeriod) return;
  real_time_factor_ = static_cast<double>(measured_frames_) / frame_rate_ / wall;
  measured_frames_ = 0;
  measured_since_ = ros::SteadyTime::now();
}

void FrameClock::count(curtain_sim::Statistics& statistics) const {
  statistics.real_time_factor = real_time_factor_;
  statistics.dropped_frames = steps_.dropped();
  statistics.clock_jumps_back = jumps_back_;
  statistics.clock_set_back = stamps_.setBack();
}

}  // namespace curtain_ros
