// SPDX-License-Identifier: BSD-3-Clause
//
// ~state, ~layers/NAME/state, ~loads, ~contacts, ~wrench/FRAME, ~mesh, ~markers and ~summary. What nobody subscribes to
// is not built; what is built is shared with subscribers in this process, not copied. And the plan (what runs for the
// scene, what is skipped) in the log, at level DEBUG.
#pragma once

#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <cstdint>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"
#include "ros/frames/frames.h"
#include "ros/outputs/geometry_cache.h"
#include "ros/outputs/layer_states.h"
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
  ///   statistics  the node's own fields; the engine's and the counters of what was sent are added to them
  ///   latest      false: another frame follows at once, so that markers of this one are not worth building
  void publish(const ros::Time& stamp, curtain_sim::Statistics statistics, bool latest);

  /// In a pause, once a frame's time: ~mesh and ~markers for those who have just come, and once a second.
  void showAgain(const ros::Time& stamp);

  /// Changes rates and tolerances from the next frame on. frame_rate [1/s]
  void tune(const NodeParams& params, double frame_rate);

  /// Fills in what was sent since construction.
  void count(curtain_sim::Statistics& statistics) const;

  /// Why the viewer's frame is not known; empty: it is, or there is none, or nobody wants the mesh.
  const std::string& viewerError() const { return viewer_error_; }

 private:
  struct Stream {
    ros::Publisher publisher;
    Pace pace;
    std::uint64_t sent = 0;

    bool due() { return pace.due(publisher.getNumSubscribers()); }
  };

  struct Wrench {
    Stream stream;
    WrenchMessages messages;
  };

  void advertiseWrenches(ros::NodeHandle& node, const NodeParams& params);
  void publishWrenches(const ros::Time& stamp);
  void publishMarkers(const ros::Time& stamp);
  curtain::MeshDetail meshDetail();
  void logPlan();

  GeometryCache geometry_;
  Frames& frames_;
  std::string viewer_frame_;
  std::string viewer_error_;
  curtain::MeshDetail detail_;
  Stream state_, loads_, contacts_, mesh_, markers_, summary_;
  StateMessages states_;
  LayerStates layers_;
  LoadMessages load_messages_;
  ContactMessages contact_messages_;
  SummaryMessages summary_messages_;
  std::vector<Wrench> wrenches_;  // by tf2 frame
  MeshMarker mesh_marker_;
  DetailMarkers detail_markers_;
  RateDivider plan_rate_;
  curtain::Plan plan_;  // that was logged last
};

}  // namespace curtain_ros
