// SPDX-License-Identifier: BSD-3-Clause
//
// The messages of ~state, ~loads, ~contacts and ~wrench/…, and what they are made of. Needs no ROS master.
#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/time.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/Contacts.h"
#include "curtain_sim/CurtainState.h"
#include "curtain_sim/Loads.h"
#include "curtain_sim/Summary.h"
#include "ros/frames/frames.h"
#include "ros/outputs/geometry_cache.h"
#include "ros/outputs/reused_message.h"
#include "ros/parameters/parameters.h"

namespace curtain_ros {

/// Flat xyz, as CurtainState holds its arrays; out is resized.
void flatten(const std::vector<curtain::Vec3>& points, std::vector<float>& out);

/// Flat xyz of the second-layer nodes of a fine mesh, in the order that CurtainState documents; out is resized.
void flattenFolds(const curtain::FineMeshTopology& topology, const curtain::FineMesh& mesh, std::vector<float>& out);

/// The engine's part of the statistics; the node's own fields are left as they are.
void toMessage(const curtain::Statistics& statistics, curtain_sim::Statistics& message);

/// A wind source as the message that would set it at this time [s], with the world frame's pose.
void toMessage(const curtain::WindParams& wind, double time, curtain_sim::WindSource& message);

/// Node states. One thread at a time.
class StateMessages {
 public:
  /// geometry must outlive this.
  StateMessages(const NodeParams& params, GeometryCache& geometry);

  /// The message of a frame.
  ///   statistics  the node's own fields; the engine's are filled in
  curtain_sim::CurtainState::ConstPtr build(const ros::Time& stamp, const curtain_sim::Statistics& statistics);

 private:
  void fill(curtain_sim::CurtainState& message);
  void fillWinds(curtain_sim::CurtainState& message);

  GeometryCache& geometry_;
  bool folds_;
  std::vector<curtain::Vec3> vectors_;
  std::optional<std::uint64_t> filled_;  // revision of the arrays in the message
  ReusedMessage<curtain_sim::CurtainState> message_;
};

/// Tensions and contact forces. One thread at a time.
class LoadMessages {
 public:
  /// simulator must outlive this.
  LoadMessages(const NodeParams& params, const curtain::Simulator& simulator);

  curtain_sim::Loads::ConstPtr build(const ros::Time& stamp);

 private:
  const curtain::Simulator& simulator_;
  std::vector<double> warp_, weft_;
  std::vector<curtain::Vec3> forces_;
  ReusedMessage<curtain_sim::Loads> message_;
};

/// What the cloth does to the obstacles that are present. One thread at a time.
class ContactMessages {
 public:
  explicit ContactMessages(const NodeParams& params);

  curtain_sim::Contacts::ConstPtr build(const curtain::Simulator& simulator, const ros::Time& stamp);

 private:
  void fillPoints(const curtain::Simulator& simulator, curtain_sim::Contacts& message);

  bool points_;
  std::vector<curtain::ContactForce> forces_;
  std::vector<std::uint32_t> place_;  // by obstacle of the scene: in the message
  ReusedMessage<curtain_sim::Contacts> message_;
};

/// What a task asks of the curtain. One thread at a time.
class SummaryMessages {
 public:
  explicit SummaryMessages(const NodeParams& params)
      : world_(params.world_frame),
        from_(params.summary_from),
        asked_(params.summary_frames),
        message_(curtain_sim::Summary()) {}

  /// frames is asked where those of ~summary_frames are.
  curtain_sim::Summary::ConstPtr build(const curtain::Simulator& simulator, const ros::Time& stamp, Frames& frames);

 private:
  std::string world_;
  curtain::Vec3 from_;
  std::vector<std::string> asked_;
  ReusedMessage<curtain_sim::Summary> message_;
};

/// What the cloth does to all obstacles on one tf2 frame: in its axes, about its origin. One thread at a time.
class WrenchMessages {
 public:
  /// obstacles  on the frame, as the simulator numbers them
  WrenchMessages(const std::string& frame, std::vector<int> obstacles);

  /// Absent obstacles feel nothing.
  geometry_msgs::WrenchStamped::ConstPtr build(const curtain::Simulator& simulator, const ros::Time& stamp);

 private:
  std::vector<int> obstacles_;
  ReusedMessage<geometry_msgs::WrenchStamped> message_;
};

}  // namespace curtain_ros
