// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: the time that frames follow. Under use_sim_time that is /clock. Otherwise frames are paced by the
// monotonic clock, so that setting the computer's clock does not reset the curtain, and stamped with ROS time.
#pragma once

#include <ros/time.h>

#include <cstdint>

#include "ros/time/stamp_keeper.h"

namespace curtain_ros {

class NodeClock {
 public:
  NodeClock() : simulated_(ros::Time::isSimTime()) {}

  bool simulated() const { return simulated_; }

  /// [ns]; 0: no /clock yet.
  std::int64_t now() const { return simulated_ ? nanoseconds(ros::Time::now()) : nanoseconds(ros::SteadyTime::now()); }

  /// ROS time of a frame at a time [ns] of this clock; times rise from call to call, but for a /clock that jumped back.
  ros::Time stampOf(std::int64_t time) {
    if (!simulated_) time = stamps_.stamp(time, readOffset());
    return ros::Time().fromNSec(static_cast<std::uint64_t>(time));
  }

  /// Times that the computer's clock was set back.
  std::uint32_t setBack() const { return stamps_.setBack(); }

 private:
  template <typename Time>
  static std::int64_t nanoseconds(const Time& time) {
    return static_cast<std::int64_t>(time.toNSec());
  }

  // The best of a few readings: a thread that is held up between two of them is rarely so again at once.
  static StampKeeper::Offset readOffset() {
    StampKeeper::Offset best;
    for (int reading = 0; reading < 3; ++reading) {
      const std::int64_t before = nanoseconds(ros::SteadyTime::now());
      const std::int64_t ros_time = nanoseconds(ros::Time::now());
      const std::int64_t after = nanoseconds(ros::SteadyTime::now());
      const StampKeeper::Offset offset = {ros_time - before - (after - before) / 2, after - before};
      if (reading == 0 || offset.doubt < best.doubt) best = offset;
      if (best.doubt <= StampKeeper::kGoodReading) break;
    }
    return best;
  }

  bool simulated_;
  StampKeeper stamps_;
};

}  // namespace curtain_ros
