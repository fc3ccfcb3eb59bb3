// SPDX-License-Identifier: BSD-3-Clause
#include "ros/outputs/state_messages.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ros/frames/geometry.h"

namespace curtain_ros {

namespace {

void toFloats(const std::vector<double>& numbers, std::vector<float>& out) {
  out.resize(numbers.size());
  std::transform(numbers.begin(), numbers.end(), out.begin(), [](double x) { return static_cast<float>(x); });
}

curtain_sim::CurtainState blankState(const NodeParams& params, const curtain::Simulator& simulator) {
  curtain_sim::CurtainState message;
  message.header.frame_id = params.world_frame;
  message.rows = static_cast<std::uint32_t>(simulator.rows());
  message.columns = static_cast<std::uint32_t>(simulator.columns());
  const curtain::ClothParams cloth = wholeCloth(simulator.scene());
  message.closed = cloth.closed;
  message.folds = static_cast<std::uint32_t>(cloth.folds);
  std::vector<double> warp, weft;
  simulator.copyRestLengths(warp, weft);
  toFloats(warp, message.warp_rest);
  toFloats(weft, message.weft_rest);
  for (const curtain::SlitParams& slit : cloth.slits) {
    message.slit_columns.push_back(static_cast<std::uint32_t>(slit.column));
    message.slit_rows.push_back(static_cast<std::uint32_t>(slit.from_row));
  }
  return message;
}

curtain_sim::Loads blankLoads(const NodeParams& params, const curtain::Simulator& simulator) {
  curtain_sim::Loads message;
  message.header.frame_id = params.world_frame;
  message.rows = static_cast<std::uint32_t>(simulator.rows());
  message.columns = static_cast<std::uint32_t>(simulator.columns());
  return message;
}

curtain_sim::Contacts blankContacts(const NodeParams& params) {
  curtain_sim::Contacts message;
  message.header.frame_id = params.world_frame;
  return message;
}

}  // namespace

void flatten(const std::vector<curtain::Vec3>& points, std::vector<float>& out) {
  out.resize(3 * points.size());
  float* to = out.data();
  for (const curtain::Vec3& point : points) {
    for (int axis = 0; axis < 3; ++axis) *to++ = static_cast<float>(point[axis]);
  }
}

void flattenFolds(const curtain::FineMeshTopology& topology, const curtain::FineMesh& mesh, std::vector<float>& out) {
  out.clear();
  const auto columns = static_cast<std::size_t>(topology.columns);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (i % columns % static_cast<std::size_t>(topology.folds) == 0) continue;  // first layer
    for (int axis = 0; axis < 3; ++axis) out.push_back(static_cast<float>(mesh.positions[i][axis]));
  }
}

void toMessage(const curtain::Statistics& statistics, curtain_sim::Statistics& message) {
  message.frame = static_cast<std::uint64_t>(statistics.frames);
  message.simulated_time = statistics.time;
  message.substeps_total = static_cast<std::uint64_t>(statistics.substeps);
  message.substeps = static_cast<std::uint32_t>(statistics.substeps_last);
  message.sweeps = static_cast<std::uint32_t>(statistics.sweeps_last);
  message.rejected = static_cast<std::uint64_t>(statistics.rejected);
  message.unsettled = static_cast<std::uint64_t>(statistics.unsettled);
  message.estimates_skipped = static_cast<std::uint64_t>(statistics.estimates_skipped);
  message.longer_substeps = static_cast<std::uint64_t>(statistics.longer_substeps);
  message.unfinished_substeps = static_cast<std::uint64_t>(statistics.unfinished_substeps);
  message.shortened_frames = static_cast<std::uint64_t>(statistics.shortened_frames);
  message.lost_time = statistics.lost_time;
  message.late_frames = static_cast<std::uint64_t>(statistics.late_frames);
  message.asleep = statistics.asleep ? 1 : 0;
  message.wakes = static_cast<std::uint64_t>(statistics.wakes);
  message.warp_stretch = statistics.warp_stretch;
  message.weft_stretch = statistics.weft_stretch;
  message.contacts = static_cast<std::uint32_t>(statistics.contacts);
  message.opening = statistics.opening;
  message.drive_force = statistics.drive_force;
  message.position_error = statistics.position_error;
  message.penetration_max = statistics.penetration_max;
  message.step_ms = 1e3 * statistics.step_seconds;
  message.step_ms_max = 1e3 * statistics.step_seconds_max;
  message.finite = statistics.finite;
  message.last_resort_substeps = static_cast<std::uint64_t>(statistics.last_resort_substeps);
  message.momentum_cut = statistics.momentum_cut;
  message.momentum_cut_last = statistics.momentum_cut_last;
  message.quality = static_cast<std::uint8_t>(statistics.quality);
  message.obstacles_waited = statistics.obstacles_waited;
  message.stops = static_cast<std::uint64_t>(statistics.stops);
  message.stops_last = static_cast<std::uint32_t>(statistics.stops_last);
}

void toMessage(const curtain::WindParams& wind, double time, curtain_sim::WindSource& message) {
  message.id = wind.id;
  message.action = curtain_sim::WindSource::ADD;
  message.pose = toPose({wind.position, Eigen::Quaterniond::FromTwoVectors(curtain::Vec3::UnitX(), wind.direction)});
  message.radius = wind.radius;
  message.half_angle = wind.half_angle;
  message.pressure = wind.pressure;
  message.unsteadiness = wind.unsteadiness;
  message.correlation_time = wind.correlation_time;
  message.profile = wind.profile == curtain::WindProfile::kRingJet ? curtain_sim::WindSource::RING_JET
                                                                   : curtain_sim::WindSource::UNIFORM;
  message.shadow = wind.shadow ? 1 : 0;
  message.lifetime = std::isfinite(wind.end) ? wind.end - time : 0.0;
}

StateMessages::StateMessages(const NodeParams& params, GeometryCache& geometry)
    : geometry_(geometry), folds_(params.state_folds), message_(blankState(params, geometry.simulator())) {}

curtain_sim::CurtainState::ConstPtr StateMessages::build(const ros::Time& stamp,
                                                         const curtain_sim::Statistics& statistics) {
  const auto message = message_.edit();
  if (filled_ != geometry_.revision()) fill(*message);
  filled_ = geometry_.revision();
  fillWinds(*message);
  message->header.stamp = stamp;
  message->statistics = statistics;
  toMessage(geometry_.simulator().statistics(), message->statistics);
  return message;
}

void StateMessages::fill(curtain_sim::CurtainState& message) {
  const curtain::Simulator& simulator = geometry_.simulator();
  flatten(geometry_.nodes(), message.positions);
  simulator.copyVelocities(vectors_);
  flatten(vectors_, message.velocities);
  simulator.copyForces(vectors_);
  flatten(vectors_, message.forces);
  if (folds_) flattenFolds(simulator.fineMeshTopology(), geometry_.fineMesh(), message.fold_nodes);
}

// They come and go without a new revision.
void StateMessages::fillWinds(curtain_sim::CurtainState& message) {
  const curtain::Simulator& simulator = geometry_.simulator();
  std::size_t count = 0;
  for (const curtain::WindParams& wind : simulator.winds()) {
    if (!blows(wind, simulator.time())) continue;
    if (message.winds.size() == count) message.winds.emplace_back();
    toMessage(wind, simulator.time(), message.winds[count++]);
  }
  message.winds.resize(count);
}

LoadMessages::LoadMessages(const NodeParams& params, const curtain::Simulator& simulator)
    : simulator_(simulator), message_(blankLoads(params, simulator)) {}

curtain_sim::Loads::ConstPtr LoadMessages::build(const ros::Time& stamp) {
  const auto message = message_.edit();
  message->header.stamp = stamp;
  simulator_.copyTensions(warp_, weft_);
  toFloats(warp_, message->warp_tension);
  toFloats(weft_, message->weft_tension);
  simulator_.copyContactForces(forces_);
  flatten(forces_, message->contact_forces);
  return message;
}

ContactMessages::ContactMessages(const NodeParams& params)
    : points_(params.contact_points), message_(blankContacts(params)) {}

curtain_sim::Contacts::ConstPtr ContactMessages::build(const curtain::Simulator& simulator, const ros::Time& stamp) {
  const auto message = message_.edit();
  message->header.stamp = stamp;
  message->obstacles.resize(static_cast<std::size_t>(simulator.obstacleCount()));
  place_.assign(message->obstacles.size(), 0);
  auto to = message->obstacles.begin();
  for (int index = 0; index < simulator.obstacleCount(); ++index) {
    if (!simulator.obstaclePresent(index)) continue;
    const curtain::ObstacleParams& obstacle = simulator.scene().obstacles[static_cast<std::size_t>(index)];
    const curtain::ContactWrench wrench = simulator.contactWrench(index);
    to->name = obstacle.name;
    to->frame = obstacle.frame;
    to->wrench.force = toVector(wrench.force);
    to->wrench.torque = toVector(wrench.torque);
    const geometry_msgs::Pose pose = toPose(simulator.obstaclePose(index));
    to->origin = pose.position;
    to->orientation = pose.orientation;
    to->lag = simulator.obstacleLag(index);
    to->contacts = static_cast<std::uint32_t>(wrench.contacts);
    place_[static_cast<std::size_t>(index)] = static_cast<std::uint32_t>(to - message->obstacles.begin());
    ++to;
  }
  message->obstacles.erase(to, message->obstacles.end());
  if (points_) fillPoints(simulator, *message);
  return message;
}

void ContactMessages::fillPoints(const curtain::Simulator& simulator, curtain_sim::Contacts& message) {
  simulator.copyContactPoints(forces_);
  message.points.clear();
  for (const curtain::ContactForce& force : forces_) {
    if (!simulator.obstaclePresent(force.obstacle)) continue;
    curtain_sim::ContactPoint& point = message.points.emplace_back();
    point.obstacle = place_[static_cast<std::size_t>(force.obstacle)];
    point.position = toPoint(force.position);
    point.normal = toVector(force.normal);
    point.normal_force = force.normal_force;
    point.friction_force = toVector(force.friction);
  }
}

WrenchMessages::WrenchMessages(const std::string& frame, std::vector<int> obstacles)
    : obstacles_(std::move(obstacles)), message_([&frame] {
        geometry_msgs::WrenchStamped blank;
        blank.header.frame_id = frame;
        return blank;
      }()) {}

geometry_msgs::WrenchStamped::ConstPtr WrenchMessages::build(const curtain::Simulator& simulator,
                                                             const ros::Time& stamp) {
  curtain::Vec3 force = curtain::Vec3::Zero(), torque = curtain::Vec3::Zero();
  for (const int index : obstacles_) {
    if (!simulator.obstaclePresent(index)) continue;
    const curtain::ContactWrench wrench = simulator.contactWrench(index);
    const curtain::Pose& offset = simulator.scene().obstacles[static_cast<std::size_t>(index)].pose;
    const auto to_frame = offset.orientation * simulator.obstaclePose(index).orientation.conjugate();
    const curtain::Vec3 pull = to_frame * wrench.force;
    force += pull;
    torque += to_frame * wrench.torque + offset.position.cross(pull);
  }
  const auto message = message_.edit();
  message->header.stamp = stamp;
  message->wrench.force = toVector(force);
  message->wrench.torque = toVector(torque);
  return message;
}

curtain_sim::Summary::ConstPtr SummaryMessages::build(const curtain::Simulator& simulator, const ros::Time& stamp,
                                                      Frames& frames) {
  const auto message = message_.edit();
  const curtain::Scene& scene = simulator.scene();
  message->header.stamp = stamp;
  message->header.frame_id = world_;
  message->simulated_time = simulator.time();
  message->at_rest = static_cast<std::uint8_t>(simulator.statistics().asleep);
  const bool on_rail = !scene.rail.path.empty();
  message->opening = on_rail ? simulator.statistics().opening : std::numeric_limits<double>::quiet_NaN();
  message->frames = asked_;
  message->frames_hidden.clear();
  for (const std::string& frame : asked_) {
    const FrameLookup at = frames.lookup(frame);
    const double hidden = at.known && simulator.hides(at.pose.position, from_) ? 1.0 : 0.0;
    message->frames_hidden.push_back(at.known ? hidden : std::numeric_limits<double>::quiet_NaN());
  }
  message->layers.clear();
  message->openings.clear();
  for (const curtain::LayerParams& layer : scene.layers) {
    message->layers.push_back(layer.name);
    message->openings.push_back(layer.rail.path.empty() ? std::numeric_limits<double>::quiet_NaN()
                                                        : simulator.opening(layer.name));
  }
  message->obstacles.clear();
  message->touching.clear();
  message->covered.clear();
  for (int k = 0; k < simulator.obstacleCount(); ++k) {
    message->obstacles.push_back(scene.obstacles[static_cast<std::size_t>(k)].name);
    const bool touches = simulator.obstaclePresent(k) && simulator.contactWrench(k).contacts > 0;
    message->touching.push_back(static_cast<std::uint8_t>(touches));
    message->covered.push_back(simulator.covered(k, from_));
  }
  return message;
}

}  // namespace curtain_ros
