// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: ~state, ~mesh, ~markers and ~contacts. What nobody subscribes to is not built.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstdint>
#include <vector>

#include "curtain_sim/Contacts.h"
#include "curtain_sim/CurtainState.h"
#include "curtain_sim/simulator.h"
#include "ros/markers.h"
#include "ros/parameters.h"

namespace curtain_ros {

/// Thins the frames out to a rate of their own.
class RateDivider {
 public:
  RateDivider(double rate, double frame_rate) : share_(rate / frame_rate) {}

  /// To be called each frame. True: this one.
  bool tick() {
    phase_ += share_;
    if (phase_ < 1.0 - 1e-9) return false;
    phase_ = phase_ < 2.0 ? phase_ - 1.0 : 0.0;
    return true;
  }

 private:
  double share_;
  double phase_ = 1.0;  // the first frame is one
};

/// Simulation thread only.
class Outputs {
 public:
  Outputs(ros::NodeHandle private_node, const NodeParams& params, const curtain::Scene& scene);

  /// Publishes a frame.
  ///   statistics  the node's own fields are filled in; the engine's and the counters of what was sent are added here
  ///   latest      false: another frame follows at once, so that pictures of this one are not worth building
  void publish(const curtain::Simulator& simulator, const ros::Time& stamp, const curtain_sim::Statistics& statistics,
               bool latest);

 private:
  void publishState(const curtain::Simulator& simulator, const ros::Time& stamp,
                    const curtain_sim::Statistics& statistics);
  void publishContacts(const curtain::Simulator& simulator, const ros::Time& stamp);

  std::string world_frame_;
  bool state_folds_;
  RateDivider mesh_rate_;
  RateDivider markers_rate_;
  bool mesh_due_ = false;
  bool markers_due_ = false;
  std::uint64_t states_sent_ = 0;
  std::uint64_t meshes_sent_ = 0;
  std::uint64_t markers_sent_ = 0;
  MeshMarker mesh_marker_;
  DetailMarkers detail_markers_;
  std::vector<curtain::Vec3> nodes_;
  curtain::FineMesh mesh_;
  ros::Publisher state_publisher_;
  ros::Publisher mesh_publisher_;
  ros::Publisher markers_publisher_;
  ros::Publisher contacts_publisher_;
};

}  // namespace curtain_ros
