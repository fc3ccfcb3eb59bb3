// SPDX-License-Identifier: BSD-3-Clause
#include "ros/outputs/state_messages.h"

#include "ros/frames/geometry.h"
#include "ros/outputs/to_messages.h"

namespace curtain_ros {

namespace {

curtain_sim::CurtainState blankState(const NodeParams& params, const curtain::Simulator& simulator) {
  curtain_sim::CurtainState message;
  message.header.frame_id = params.world_frame;
  message.rows = static_cast<std::uint32_t>(simulator.rows());
  message.columns = static_cast<std::uint32_t>(simulator.columns());
  message.closed = simulator.scene().cloth.closed;
  message.folds = static_cast<std::uint32_t>(simulator.scene().cloth.folds);
  return message;
}

curtain_sim::Contacts blankContacts(const NodeParams& params) {
  curtain_sim::Contacts message;
  message.header.frame_id = params.world_frame;
  return message;
}

}  // namespace

StateMessages::StateMessages(const NodeParams& params, Shape& shape)
    : shape_(shape), folds_(params.state_folds), pool_(blankState(params, shape.simulator())) {}

curtain_sim::CurtainState::ConstPtr StateMessages::build(const ros::Time& stamp,
                                                         const curtain_sim::Statistics& statistics) {
  auto& [message, revision] = pool_.take();
  if (revision != shape_.revision()) fill(*message);
  revision = shape_.revision();
  message->header.stamp = stamp;
  message->statistics = statistics;
  toMessage(shape_.simulator().statistics(), message->statistics);
  return message;
}

void StateMessages::fill(curtain_sim::CurtainState& message) {
  const curtain::Simulator& simulator = shape_.simulator();
  flatten(shape_.nodes(), message.positions);
  simulator.copyVelocities(vectors_);
  flatten(vectors_, message.velocities);
  simulator.copyForces(vectors_);
  flatten(vectors_, message.forces);
  if (folds_) flattenFolds(simulator.fineMeshTopology(), shape_.fineMesh(), message.fold_nodes);
}

ContactMessages::ContactMessages(const NodeParams& params) : pool_(blankContacts(params)) {}

curtain_sim::Contacts::ConstPtr ContactMessages::build(const curtain::Simulator& simulator, const ros::Time& stamp) {
  const auto& message = pool_.take().message;
  message->header.stamp = stamp;
  std::size_t present = 0;
  for (int index = 0; index < simulator.obstacleCount(); ++index) present += simulator.obstaclePresent(index);
  message->obstacles.resize(present);
  auto to = message->obstacles.begin();
  for (int index = 0; index < simulator.obstacleCount(); ++index) {
    if (!simulator.obstaclePresent(index)) continue;
    const curtain::ObstacleParams& obstacle = simulator.scene().obstacles[static_cast<std::size_t>(index)];
    const curtain::ContactWrench wrench = simulator.contactWrench(index);
    to->name = obstacle.name;
    to->frame = obstacle.frame;
    to->wrench.force = toVector(wrench.force);
    to->wrench.torque = toVector(wrench.torque);
    to->origin = toPoint(simulator.obstaclePose(index).position);
    to->contacts = static_cast<std::uint32_t>(wrench.contacts);
    ++to;
  }
  return message;
}

}  // namespace curtain_ros
