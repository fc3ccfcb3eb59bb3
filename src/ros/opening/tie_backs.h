// SPDX-License-Identifier: BSD-3-Clause
//
// Tie-backs of a curtain: service ~tie_back. The answer needs the scene's ids alone, so the callback leaves the request
// in a mailbox, and the simulation thread works it off at the start of a frame.
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <deque>
#include <string>
#include <vector>

#include "curtain_sim/TieBack.h"
#include "curtain_sim/simulator.h"
#include "ros/inputs/mailbox.h"

namespace curtain_ros {

class TieBacks {
 public:
  /// For a scene with tie-backs.
  TieBacks(ros::NodeHandle private_node, const curtain::Scene& scene);

  /// Before a frame: closes and opens what was asked for, in order. Simulation thread.
  void apply(curtain::Simulator& simulator);

 private:
  bool answer(curtain_sim::TieBack::Request& request, curtain_sim::TieBack::Response& response);

  std::vector<std::string> ids_;
  Mailbox<curtain_sim::TieBack::Request> mailbox_;
  std::deque<curtain_sim::TieBack::Request> requests_;  // scratch
  ros::ServiceServer server_;
};

}  // namespace curtain_ros
