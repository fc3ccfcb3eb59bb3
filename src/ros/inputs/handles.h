// SPDX-License-Identifier: BSD-3-Clause
//
// Handles on the hem that can be dragged in rviz. A dragged handle pulls its node by a spring, through the mailbox of
// drag_force; a released one follows its node.
#pragma once

#include <interactive_markers/interactive_marker_server.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "ros/inputs/inputs.h"
#include "ros/parameters/parameters.h"
#include "ros/time/pace.h"

namespace curtain_ros {

/// Columns of the hem that get a handle: five, evenly spread, both corners among them (fewer on a narrow cloth;
/// closed cloth has no corners).
std::vector<int> handleColumns(const curtain::ClothParams& cloth);

/// Built and updated by the simulation thread; feedback comes in on any other.
class Handles {
 public:
  /// Serves ~handles. inputs must outlive this.
  Handles(ros::NodeHandle private_node, const NodeParams& params, const curtain::Simulator& simulator, Inputs& inputs);

  /// Frames a second, from now on.
  void setFrameRate(double frame_rate);

  /// To be called each frame: about ten times a second moves the handles to their nodes, if somebody subscribed and
  /// either may have moved.
  void update(const curtain::Simulator& simulator);

 private:
  struct Handle {
    std::string name;
    curtain::NodeIndex node;
  };

  void onFeedback(const Handle& handle, const visualization_msgs::InteractiveMarkerFeedback& feedback);

  double stiffness_;
  Inputs& inputs_;
  RateDivider rate_;
  std::vector<Handle> handles_;
  std::optional<std::uint64_t> shown_;  // revision of the nodes that the handles were moved to
  std::atomic<bool> touched_{false};    // a handle was dragged since then
  interactive_markers::InteractiveMarkerServer server_;
  ros::Publisher update_watch_;  // shares the server's topic, to count its subscribers
};

}  // namespace curtain_ros
