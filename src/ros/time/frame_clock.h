// SPDX-License-Identifier: BSD-3-Clause
//
// The time that frames follow.
//
//   /clock, under use_sim_time          frames are due, and stamped, by it
//   the computer's clock, otherwise     the monotonic clock paces the frames, so that setting the clock does not reset
//                                       the curtain, and they are stamped with ROS time
//   its own, with ~publish_clock        the monotonic clock paces the frames. Each takes the clock on by its length,
//                                       whenever it is made, so none is ever dropped
#pragma once

#include <ros/time.h>

#include <chrono>
#include <cstdint>
#include <string>

#include "curtain_sim/Statistics.h"
#include "ros/time/lateness.h"
#include "ros/time/stamp_keeper.h"
#include "ros/time/step_clock.h"

namespace curtain_ros {

/// Simulation thread only.
class FrameClock {
 public:
  /// As of StepClock. own: there is no other /clock.
  FrameClock(double frame_rate, int max_catch_up, bool own);

  /// Frames follow a /clock that others drive.
  bool follows() const { return source_ == Source::kClock; }

  /// [ns], by which frames are due; 0: no /clock yet.
  std::int64_t now() const { return follows() ? nanoseconds(ros::Time::now()) : nanoseconds(ros::SteadyTime::now()); }

  /// Frames that are due; warns about a clock that jumped back.
  StepClock::Due update(std::int64_t now);
  /// The same in a pause, as of StepClock.
  StepClock::Due pass(std::int64_t now);

  /// Goes on to the next frame that is due; its stamp. Stamps rise, unless /clock jumped back.
  ros::Time advance();
  /// The stamp of a frame that is made in a pause. Not where follows().
  ros::Time stampInPause();

  /// ROS time as the node goes by: its own clock, or everybody's.
  ros::Time rosTime() const { return source_ == Source::kOwn ? toTime(own_now_) : ros::Time::now(); }

  /// [ns], for periods of the node's clock.
  std::int64_t nodeTime() const { return source_ == Source::kOwn ? own_now_ : now(); }

  /// Sets its own clock on by so many seconds, from where it begins: at 1 s, since 0 is no time in ROS.
  void begin(double seconds);
  /// Changes the frames' length.
  void setRate(double frame_rate);
  /// A pause is over: the speed is measured again.
  void resume();

  /// Until the next frame is due; a /clock that others drive is polled.
  std::chrono::nanoseconds untilNext() const;

  /// To be called when the frames of an update() are made. Warns about frames dropped, and why, and clocks set back
  /// since the last call.
  void logLosses();

  void count(curtain_sim::Statistics& statistics) const;

 private:
  enum class Source { kClock, kComputer, kOwn };

  template <typename Time>
  static std::int64_t nanoseconds(const Time& time) {
    return static_cast<std::int64_t>(time.toNSec());
  }
  static ros::Time toTime(std::int64_t nanoseconds) {
    return ros::Time().fromNSec(static_cast<std::uint64_t>(nanoseconds));
  }

  StepClock::Due told(const StepClock::Due& due);
  void measureLateness(std::int64_t now);
  ros::Time stamp(std::int64_t time);
  void measureSpeed();
  std::uint64_t dropped() const { return source_ == Source::kOwn ? 0 : steps_.dropped(); }

  Source source_;
  double frame_rate_;
  StepClock steps_;
  StepClock own_;             // the grid of its own clock
  std::int64_t own_now_ = 0;  // [ns]
  StampKeeper stamps_;
  std::uint32_t jumps_back_ = 0;
  std::uint64_t logged_dropped_ = 0;
  std::uint32_t logged_set_back_ = 0;
  // Since the last look at the clock that frames are due by.
  std::int64_t measured_at_ = 0;  // of that clock [ns]
  ros::SteadyTime measured_;      // on the monotonic clock; zero: not yet
  double thread_seconds_ = 0.0;   // computing time of this thread then [s]
  Lateness lateness_;             // frames and their time since then; the rest is of the look before
  std::string cause_;             // of the last frames dropped
  // Frames and their start on the monotonic clock, of the second that is measured now.
  std::int64_t measured_frames_ = 0;
  ros::SteadyTime measured_since_ = ros::SteadyTime::now();
  double real_time_factor_ = 0.0;
};

}  // namespace curtain_ros
