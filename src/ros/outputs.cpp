// SPDX-License-Identifier: BSD-3-Clause
#include "ros/outputs.h"

#include <boost/make_shared.hpp>

#include "ros/conversions.h"

namespace curtain_ros {

Outputs::Outputs(ros::NodeHandle private_node, const NodeParams& params, const curtain::Scene& scene)
    : world_frame_(params.world_frame),
      state_folds_(params.state_folds),
      mesh_rate_(params.mesh_rate, scene.solver.frame_rate),
      markers_rate_(params.markers_rate, scene.solver.frame_rate),
      mesh_marker_(params.world_frame),
      detail_markers_(params.world_frame),
      // Late listeners want the newest frame, not the ones they missed.
      state_publisher_(private_node.advertise<curtain_sim::CurtainState>("state", 2)),
      mesh_publisher_(private_node.advertise<visualization_msgs::Marker>("mesh", 1)),
      markers_publisher_(private_node.advertise<visualization_msgs::MarkerArray>("markers", 1)),
      contacts_publisher_(private_node.advertise<curtain_sim::Contacts>("contacts", 2)) {}

void Outputs::publish(const curtain::Simulator& simulator, const ros::Time& stamp,
                      const curtain_sim::Statistics& statistics, bool latest) {
  mesh_due_ = mesh_rate_.tick() || mesh_due_;
  markers_due_ = markers_rate_.tick() || markers_due_;
  if (state_publisher_.getNumSubscribers() > 0) publishState(simulator, stamp, statistics);
  if (contacts_publisher_.getNumSubscribers() > 0) publishContacts(simulator, stamp);
  if (!latest) return;
  if (mesh_due_ && mesh_publisher_.getNumSubscribers() > 0) {
    mesh_publisher_.publish(mesh_marker_.build(simulator, stamp));
    ++meshes_sent_;
  }
  if (markers_due_ && markers_publisher_.getNumSubscribers() > 0) {
    markers_publisher_.publish(detail_markers_.build(simulator, stamp));
    ++markers_sent_;
  }
  mesh_due_ = false;
  markers_due_ = false;
}

void Outputs::publishState(const curtain::Simulator& simulator, const ros::Time& stamp,
                           const curtain_sim::Statistics& statistics) {
  // A message of its own each time: nodelets get this very object and may keep it.
  const auto message = boost::make_shared<curtain_sim::CurtainState>();
  message->header.frame_id = world_frame_;
  message->header.stamp = stamp;
  message->rows = static_cast<std::uint32_t>(simulator.rows());
  message->columns = static_cast<std::uint32_t>(simulator.columns());
  message->closed = simulator.scene().cloth.closed;
  message->folds = static_cast<std::uint32_t>(simulator.scene().cloth.folds);
  simulator.copyPositions(nodes_);
  flatten(nodes_, message->positions);
  simulator.copyVelocities(nodes_);
  flatten(nodes_, message->velocities);
  simulator.copyForces(nodes_);
  flatten(nodes_, message->forces);
  if (state_folds_) {
    simulator.copyFineMesh(mesh_);
    flattenFolds(simulator.fineMeshTopology(), mesh_, message->fold_nodes);
  }
  message->statistics = statistics;
  toMessage(simulator.statistics(), message->statistics);
  message->statistics.states_sent = ++states_sent_;
  message->statistics.meshes_sent = meshes_sent_;
  message->statistics.markers_sent = markers_sent_;
  state_publisher_.publish(curtain_sim::CurtainState::ConstPtr(message));
}

void Outputs::publishContacts(const curtain::Simulator& simulator, const ros::Time& stamp) {
  const auto message = boost::make_shared<curtain_sim::Contacts>();
  message->header.frame_id = world_frame_;
  message->header.stamp = stamp;
  for (int index = 0; index < simulator.obstacleCount(); ++index) {
    if (!simulator.obstaclePresent(index)) continue;
    const curtain::ObstacleParams& obstacle = simulator.scene().obstacles[static_cast<std::size_t>(index)];
    const curtain::ContactWrench wrench = simulator.contactWrench(index);
    curtain_sim::ObstacleContact contact;
    contact.name = obstacle.name;
    contact.frame = obstacle.frame;
    contact.wrench.force = toVector(wrench.force);
    contact.wrench.torque = toVector(wrench.torque);
    contact.origin = toPoint(simulator.obstaclePose(index).position);
    contact.contacts = static_cast<std::uint32_t>(wrench.contacts);
    message->obstacles.push_back(contact);
  }
  contacts_publisher_.publish(curtain_sim::Contacts::ConstPtr(message));
}

}  // namespace curtain_ros
