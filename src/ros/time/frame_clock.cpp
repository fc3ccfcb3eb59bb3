// SPDX-License-Identifier: BSD-3-Clause
#include "ros/time/frame_clock.h"

#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#include "ros/time/warn_period.h"

namespace curtain_ros {

namespace {
constexpr std::chrono::milliseconds kClockPoll(1);
constexpr double kSpeedPeriod = 1.0;  // [s] that the real-time factor is measured over
constexpr double kOrigin = 1.0;       // [s] of its own clock

// Computing time of this thread [s]. That of others on a busy computer does not count.
double threadSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

FrameClock::FrameClock(double frame_rate, int max_catch_up, bool own)
    : source_(own                      ? Source::kOwn
              : ros::Time::isSimTime() ? Source::kClock
                                       : Source::kComputer),
      frame_rate_(frame_rate),
      steps_(frame_rate, max_catch_up),
      own_(frame_rate, max_catch_up) {
  begin(0.0);
}

void FrameClock::begin(double seconds) {
  own_now_ = std::llround(1e9 * (kOrigin + seconds));
  own_ = StepClock(frame_rate_, 1);
  own_.update(own_now_);
}

void FrameClock::setRate(double frame_rate) {
  if (frame_rate == frame_rate_) return;
  frame_rate_ = frame_rate;
  steps_.setRate(frame_rate);
  own_.setRate(frame_rate);
  resume();
}

void FrameClock::resume() {
  measured_frames_ = 0;
  measured_since_ = ros::SteadyTime::now();
  real_time_factor_ = 0.0;
}

StepClock::Due FrameClock::update(std::int64_t now) {
  const std::uint64_t before = dropped();
  const StepClock::Due due = told(steps_.update(now));
  measureLateness(now);
  if (dropped() > before) cause_ = causeOf(lateness_, 1.0 / frame_rate_);
  lateness_.frames = due.frames;
  return due;
}

StepClock::Due FrameClock::pass(std::int64_t now) {
  measureLateness(now);
  lateness_.frames = 0;
  return told(steps_.pass(now));
}

void FrameClock::measureLateness(std::int64_t now) {
  const ros::SteadyTime here = ros::SteadyTime::now();
  lateness_.due = 1e-9 * static_cast<double>(now - measured_at_);
  lateness_.passed = measured_.isZero() ? lateness_.due : (here - measured_).toSec();
  measured_at_ = now;
  measured_ = here;
  thread_seconds_ = threadSeconds();
}

StepClock::Due FrameClock::told(const StepClock::Due& due) {
  if (due.restarted) {
    ++jumps_back_;
    ROS_WARN("/clock jumped back: the curtain starts again from the scene");
  }
  return due;
}

ros::Time FrameClock::advance() { return stamp(steps_.advance()); }

ros::Time FrameClock::stampInPause() { return stamp(now()); }

// time [ns]: of the frame, by the clock that it is due by.
ros::Time FrameClock::stamp(std::int64_t time) {
  measureSpeed();
  if (source_ == Source::kClock) return toTime(time);
  if (source_ == Source::kOwn) return toTime(own_now_ = own_.advance());
  const std::int64_t before = nanoseconds(ros::SteadyTime::now());
  const std::int64_t ros_time = nanoseconds(ros::Time::now());
  const std::int64_t after = nanoseconds(ros::SteadyTime::now());
  return toTime(stamps_.stamp(time, {ros_time - before - (after - before) / 2, after - before}));
}

std::chrono::nanoseconds FrameClock::untilNext() const {
  if (follows()) return kClockPoll;
  return std::chrono::nanoseconds(std::max<std::int64_t>(steps_.next() - now(), 0));
}

void FrameClock::logLosses() {
  lateness_.spent = threadSeconds() - thread_seconds_;
  const std::uint64_t lost = dropped();
  if (lost > logged_dropped_) {
    ROS_WARN_STREAM_THROTTLE(kWarnPeriod,
                             "dropped " << lost - logged_dropped_ << " frames (" << lost << " so far): " << cause_);
  }
  logged_dropped_ = lost;
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
  statistics.dropped_frames = dropped();
  statistics.clock_jumps_back = jumps_back_;
  statistics.clock_set_back = stamps_.setBack();
}

}  // namespace curtain_ros
