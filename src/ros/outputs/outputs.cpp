// SPDX-License-Identifier: BSD-3-Clause
#include "ros/outputs/outputs.h"

#include <ros/console.h>

namespace curtain_ros {

namespace {
constexpr double kPicturesAtRest = 1.0;  // [1/s]
constexpr double kWarnPeriod = 10.0;     // [s] between warnings
}  // namespace

Outputs::Outputs(ros::NodeHandle private_node, const NodeParams& params, const curtain::Simulator& simulator,
                 Frames& frames)
    : shape_(simulator),
      frames_(frames),
      viewer_frame_(params.mesh_viewer_frame),
      state_pace_(params.state_rate, params.state_rest_rate, simulator.scene().solver.frame_rate),
      contacts_pace_(state_pace_),
      mesh_pace_(params.mesh_rate, kPicturesAtRest, simulator.scene().solver.frame_rate),
      markers_pace_(params.markers_rate, kPicturesAtRest, simulator.scene().solver.frame_rate),
      states_(params, shape_),
      contacts_(params),
      mesh_(params.world_frame, shape_),
      details_(params.world_frame, shape_),
      // Late listeners want the newest frame, not the ones they missed.
      state_publisher_(private_node.advertise<curtain_sim::CurtainState>("state", 2)),
      mesh_publisher_(private_node.advertise<visualization_msgs::Marker>("mesh", 1)),
      markers_publisher_(private_node.advertise<visualization_msgs::MarkerArray>("markers", 1)),
      contacts_publisher_(private_node.advertise<curtain_sim::Contacts>("contacts", 2)) {
  detail_.tolerance = params.mesh_tolerance;
  detail_.viewer_tolerance = params.mesh_viewer_tolerance;
}

void Outputs::publish(const ros::Time& stamp, curtain_sim::Statistics statistics, bool latest) {
  for (Pace* pace : {&state_pace_, &contacts_pace_, &mesh_pace_, &markers_pace_}) pace->tick();
  if (state_pace_.due(state_publisher_.getNumSubscribers()) && state_pace_.send(shape_.revision())) {
    ++states_sent_;
    count(statistics);
    state_publisher_.publish(states_.build(stamp, statistics));
  }
  if (contacts_pace_.due(contacts_publisher_.getNumSubscribers()) && contacts_pace_.send(shape_.revision())) {
    contacts_publisher_.publish(contacts_.build(shape_.simulator(), stamp));
  }
  if (latest) publishPictures(stamp);
}

void Outputs::publishPictures(const ros::Time& stamp) {
  if (mesh_pace_.due(mesh_publisher_.getNumSubscribers()) && mesh_pace_.send(mesh_.look(meshDetail()))) {
    mesh_publisher_.publish(mesh_.build(stamp));
    ++meshes_sent_;
  }
  if (markers_pace_.due(markers_publisher_.getNumSubscribers()) && markers_pace_.send(details_.look())) {
    markers_publisher_.publish(details_.build(stamp));
    ++markers_sent_;
  }
}

void Outputs::count(curtain_sim::Statistics& statistics) const {
  statistics.states_sent = states_sent_;
  statistics.meshes_sent = meshes_sent_;
  statistics.markers_sent = markers_sent_;
}

// A viewer that tf2 does not know is one that sees everything: full detail. One that was known stays where it was.
curtain::MeshDetail Outputs::meshDetail() {
  if (viewer_frame_.empty()) return detail_;
  const FrameLookup viewer = frames_.lookup(viewer_frame_);
  if (viewer.known) detail_.viewer = viewer.pose.position;
  viewer_error_ = viewer.may_come ? "" : viewer.error;
  if (!viewer_error_.empty()) {
    ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "the frame '" << viewer_frame_ << "' of ~mesh_viewer_frame is not known in '"
                                                        << frames_.world() << "', ~mesh is made for "
                                                        << (detail_.viewer ? "where it was last" : "any eye") << ": "
                                                        << viewer_error_);
  }
  return detail_;
}

}  // namespace curtain_ros
