// SPDX-License-Identifier: BSD-3-Clause
//
// Services ~attach and ~detach: cloth that is tied to a tf2 frame until somebody unties it. For the engine a tie is a
// grasp, as those of ~grasp are; it has no client, and so no feedback.
#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <functional>
#include <string>
#include <vector>

#include "curtain_sim/Attach.h"
#include "curtain_sim/Detach.h"
#include "curtain_sim/simulator.h"
#include "ros/frames/followed_frame.h"
#include "ros/services/calls.h"
#include "ros/services/service_threads.h"

namespace curtain_ros {

class Ties {
 public:
  struct Surroundings {
    Calls& calls;
    curtain::Simulator& simulator;
    Frames& frames;
    std::function<ros::Time()> now;  ///< of the node's clock; called by the simulation thread
  };
  /// timeout: ~grasp_timeout [s], > 0. What surrounds it must outlive it.
  Ties(const ros::NodeHandle& private_node, double timeout, Surroundings around);

  /// Before a frame: what is tied goes where the frames are. Simulation thread, as all that follows.
  void apply();
  /// After a frame: ties that were torn are gone.
  void update();
  /// The simulation begins again, or goes on from a snapshot: all are untied.
  void restart();

 private:
  struct Tie {
    std::string id;
    FollowedFrame frame;
  };

  bool attach(curtain_sim::Attach::Request& request, curtain_sim::Attach::Response& response);
  bool detach(curtain_sim::Detach::Request& request, curtain_sim::Detach::Response& response);
  bool tie(const curtain_sim::Attach::Request& request, curtain_sim::Attach::Response& response);
  void untie(const std::string& id, curtain_sim::Detach::Response& response);
  bool follow(Tie& tie);
  template <typename Stays>
  void keep(const Stays& stays);

  double timeout_;
  Surroundings around_;
  std::vector<Tie> ties_;  // in the order in which they were made
  ServiceThreads thread_;
  ros::ServiceServer attach_, detach_;
};

}  // namespace curtain_ros
