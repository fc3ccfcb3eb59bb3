// SPDX-License-Identifier: BSD-3-Clause
//
// Services that command the frames: ~reset, ~pause and ~step.
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <string>

#include "curtain_sim/Step.h"
#include "ros/services/calls.h"
#include "ros/services/lock_step.h"
#include "ros/services/service_threads.h"

namespace curtain_ros {

/// What callers are told once the node stops.
extern const char kStops[];

class ControlServices {
 public:
  struct Actions {
    std::function<void()> reset;           ///< back to the scene's start
    std::function<void(bool)> set_paused;  ///< stops the frames, or goes on
    LockStep* lock_step;                   ///< for ~step
    std::string no_step;                   ///< why frames can't be asked for at all; empty: they can
  };
  /// actions are called by the simulation thread, through calls; both must outlive this.
  ControlServices(const ros::NodeHandle& private_node, Calls& calls, Actions actions);

 private:
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool step(curtain_sim::Step::Request& request, curtain_sim::Step::Response& response);

  Calls& calls_;
  Actions actions_;
  // Callers of ~step wait for long: the others must not wait behind them.
  ServiceThreads short_, long_;
  ros::ServiceServer reset_, pause_, step_;
};

}  // namespace curtain_ros
