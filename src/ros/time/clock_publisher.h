// SPDX-License-Identifier: BSD-3-Clause
//
// ~publish_clock: the node is the clock of a system under use_sim_time.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <rosgraph_msgs/Clock.h>

namespace curtain_ros {

class ClockPublisher {
 public:
  /// Advertises /clock. Whoever comes later gets the last time at once.
  ClockPublisher() : publisher_(ros::NodeHandle().advertise<rosgraph_msgs::Clock>("/clock", 1, true)) {}

  void publish(const ros::Time& now) {
    rosgraph_msgs::Clock clock;
    clock.clock = now;
    publisher_.publish(clock);
  }

 private:
  ros::Publisher publisher_;
};

}  // namespace curtain_ros
