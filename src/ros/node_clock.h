// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: the time that frames follow. Under use_sim_time that is /clock. Otherwise frames are paced by the
// monotonic clock, so that setting the computer's clock does not reset the curtain, and stamped with ROS time.
#pragma once

#include <ros/time.h>

#include <cstdint>

namespace curtain_ros {

class NodeClock {
 public:
  NodeClock() : simulated_(ros::Time::isSimTime()) {}

  bool simulated() const { return simulated_; }

  /// [ns]; 0: no /clock yet.
  std::int64_t now() const {
    return simulated_ ? static_cast<std::int64_t>(ros::Time::now().toNSec())
                      : static_cast<std::int64_t>(ros::SteadyTime::now().toNSec());
  }

  /// ROS time of a time [ns] of this clock.
  ros::Time stampOf(std::int64_t time) const {
    if (simulated_) return ros::Time().fromNSec(static_cast<std::uint64_t>(time));
    const std::int64_t ago = now() - time;
    return ros::Time().fromNSec(static_cast<std::uint64_t>(static_cast<std::int64_t>(ros::Time::now().toNSec()) - ago));
  }

 private:
  bool simulated_;
};

}  // namespace curtain_ros
