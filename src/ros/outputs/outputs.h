// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: ~state, ~contacts, ~mesh and ~markers. What nobody subscribes to is not built; what is built is shared with
// subscribers in this process, not copied.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstdint>
#include <string>

#include "curtain_sim/simulator.h"
#include "ros/frames/frames.h"
#include "ros/outputs/geometry_cache.h"
#include "ros/outputs/markers.h"
#include "ros/outputs/state_messages.h"
#include "ros/parameters/parameters.h"
#include "ros/time/pace.h"

namespace curtain_ros {

/// Simulation thread only.
class Outputs {
 public:
  /// simulator and frames must outlive this. frames is asked where the viewer is, if the parameters name one.
  Outputs(ros::NodeHandle private_node, const NodeParams& params, const curtain::Simulator& simulator, Frames& frames);

  /// Publishes a frame.
  ///   statistics  the node's own fields are filled in; the engine's and the counters of what was sent are added to
  ///   them latest      false: another frame follows at once, so that pictures of this one are not worth building
  void publish(const ros::Time& stamp, curtain_sim::Statistics statistics, bool latest);

  /// Adds what was sent since construction.
  void count(curtain_sim::Statistics& statistics) const;

  /// Why the viewer's frame is not known; empty: it is, or there is none, or nobody wants the mesh.
  const std::string& viewerError() const { return viewer_error_; }

 private:
  void publishPictures(const ros::Time& stamp);
  curtain::MeshDetail meshDetail();

  Shape shape_;
  Frames& frames_;
  std::string viewer_frame_;
  std::string viewer_error_;
  curtain::MeshDetail detail_;
  Pace state_pace_;
  Pace contacts_pace_;
  Pace mesh_pace_;
  Pace markers_pace_;
  StateMessages states_;
  ContactMessages contacts_;
  MeshMarker mesh_;
  DetailMarkers details_;
  std::uint64_t states_sent_ = 0;
  std::uint64_t meshes_sent_ = 0;
  std::uint64_t markers_sent_ = 0;
  ros::Publisher state_publisher_;
  ros::Publisher mesh_publisher_;
  ros::Publisher markers_publisher_;
  ros::Publisher contacts_publisher_;
};

}  // namespace curtain_ros
