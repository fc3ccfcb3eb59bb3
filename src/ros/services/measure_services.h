// SPDX-License-Identifier: BSD-3-Clause
//
// Services that measure the cloth as it is between two frames: ~distance.
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <string>
#include <vector>

#include "curtain_sim/Distance.h"
#include "curtain_sim/simulator.h"
#include "ros/services/calls.h"
#include "ros/services/service_threads.h"

namespace curtain_ros {

class MeasureServices {
 public:
  /// world: its frame's name. simulator is read by the simulation thread, through calls; both must outlive this.
  MeasureServices(const ros::NodeHandle& private_node, Calls& calls, const curtain::Simulator& simulator,
                  std::string world);

 private:
  bool distance(curtain_sim::Distance::Request& request, curtain_sim::Distance::Response& response);
  void measure(const std::string& name, curtain_sim::Distance::Response& response) const;

  Calls& calls_;
  const curtain::Simulator& simulator_;
  const std::vector<std::string> known_;  // obstacles, in the scene's order
  const std::string world_;
  ServiceThreads thread_;
  ros::ServiceServer distance_;
};

}  // namespace curtain_ros
