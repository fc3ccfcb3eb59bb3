// SPDX-License-Identifier: BSD-3-Clause
#include "ros/outputs/outputs.h"

#include <ros/console.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "ros/time/warn_period.h"

namespace curtain_ros {

namespace {
constexpr double kMarkersAtRest = 1.0;  // [1/s]
constexpr double kPlanRate = 1.0;       // [1/s]

// Names of frames may have letters that names of topics can't.
std::string topicOf(std::string frame) {
  const auto is_good = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '/'; };
  std::replace_if(
      frame.begin(), frame.end(), [&](char c) { return !is_good(c); }, '_');
  return "wrench/" + frame;
}

// Of what tells of each frame. Short, since late listeners want the newest frame and not the ones they missed; but
// frames that are made up for come all at once.
std::uint32_t queueOf(const NodeParams& params) { return static_cast<std::uint32_t>(std::max(2, params.max_catch_up)); }
}  // namespace

Outputs::Outputs(ros::NodeHandle node, const NodeParams& params, const curtain::Simulator& simulator, Frames& frames)
    : geometry_(simulator),
      frames_(frames),
      viewer_frame_(params.mesh_viewer_frame),
      state_{node.advertise<curtain_sim::CurtainState>("state", queueOf(params)),
             {params.state_rate, params.state_rest_rate, simulator.scene().solver.frame_rate}},
      loads_{node.advertise<curtain_sim::Loads>("loads", queueOf(params)), state_.pace},
      contacts_{node.advertise<curtain_sim::Contacts>("contacts", queueOf(params)), state_.pace},
      mesh_{node.advertise<visualization_msgs::Marker>("mesh", 1),
            {params.mesh_rate, kMarkersAtRest, simulator.scene().solver.frame_rate}},
      markers_{node.advertise<visualization_msgs::MarkerArray>("markers", 1),
               {params.markers_rate, kMarkersAtRest, simulator.scene().solver.frame_rate}},
      summary_{node.advertise<curtain_sim::Summary>("summary", 1), markers_.pace},
      states_(params, geometry_),
      layers_(node, simulator, queueOf(params), state_.pace),
      load_messages_(params, simulator),
      contact_messages_(params),
      summary_messages_(params),
      mesh_marker_(params.world_frame, geometry_),
      detail_markers_(params.world_frame, geometry_, params.contact_points),
      plan_rate_(kPlanRate, simulator.scene().solver.frame_rate) {
  advertiseWrenches(node, params);
  tune(params, simulator.scene().solver.frame_rate);
}

void Outputs::tune(const NodeParams& params, double frame_rate) {
  for (Stream* stream : {&state_, &loads_, &contacts_}) {
    stream->pace.setRates(params.state_rate, params.state_rest_rate, frame_rate);
  }
  layers_.setRates(params.state_rate, params.state_rest_rate, frame_rate);
  for (Wrench& wrench : wrenches_) wrench.stream.pace.setRates(params.state_rate, params.state_rest_rate, frame_rate);
  mesh_.pace.setRates(params.mesh_rate, kMarkersAtRest, frame_rate);
  for (Stream* stream : {&markers_, &summary_}) stream->pace.setRates(params.markers_rate, kMarkersAtRest, frame_rate);
  plan_rate_.setRate(kPlanRate, frame_rate);
  detail_.tolerance = params.mesh_tolerance;
  detail_.viewer_tolerance = params.mesh_viewer_tolerance;
}

void Outputs::advertiseWrenches(ros::NodeHandle& node, const NodeParams& params) {
  std::map<std::string, std::vector<int>> obstacles;  // by frame
  for (int index = 0; index < geometry_.simulator().obstacleCount(); ++index) {
    const auto at = static_cast<std::size_t>(index);
    obstacles[frames_.resolve(geometry_.simulator().scene().obstacles[at].frame)].push_back(index);
  }
  for (const auto& [frame, on_it] : obstacles) {
    wrenches_.push_back(
        {{node.advertise<geometry_msgs::WrenchStamped>(topicOf(frame), queueOf(params)), contacts_.pace},
         WrenchMessages(frame, on_it)});
  }
}

void Outputs::showAgain(const ros::Time& stamp) {
  for (Stream* stream : {&mesh_, &markers_, &summary_}) stream->pace.tick();
  publishMarkers(stamp);
}

void Outputs::publish(const ros::Time& stamp, curtain_sim::Statistics statistics, bool latest) {
  for (Stream* stream : {&state_, &loads_, &contacts_, &mesh_, &markers_, &summary_}) stream->pace.tick();
  publishWrenches(stamp);
  const bool of_all = state_.due() && state_.pace.send(geometry_.revision());
  const bool of_layers = layers_.due(geometry_.revision());
  if (of_all || of_layers) {
    if (of_all) ++state_.sent;
    count(statistics);
    const curtain_sim::CurtainState::ConstPtr state = states_.build(stamp, statistics);
    if (of_all) state_.publisher.publish(state);
    if (of_layers) layers_.publish(*state);
  }
  if (loads_.due() && loads_.pace.send(geometry_.revision())) {
    loads_.publisher.publish(load_messages_.build(stamp));
  }
  if (contacts_.due() && contacts_.pace.send(geometry_.revision())) {
    contacts_.publisher.publish(contact_messages_.build(geometry_.simulator(), stamp));
  }
  if (latest) publishMarkers(stamp);
  logPlan();
}

void Outputs::publishWrenches(const ros::Time& stamp) {
  for (Wrench& wrench : wrenches_) {
    wrench.stream.pace.tick();
    if (wrench.stream.due() && wrench.stream.pace.send(geometry_.revision()))
      wrench.stream.publisher.publish(wrench.messages.build(geometry_.simulator(), stamp));
  }
}

void Outputs::publishMarkers(const ros::Time& stamp) {
  if (mesh_.due() && mesh_.pace.send(mesh_marker_.update(meshDetail()))) {
    mesh_.publisher.publish(mesh_marker_.build(stamp));
    ++mesh_.sent;
  }
  if (markers_.due() && markers_.pace.send(detail_markers_.update())) {
    markers_.publisher.publish(detail_markers_.build(stamp));
    ++markers_.sent;
  }
  if (summary_.due() && summary_.pace.send(geometry_.revision()))
    summary_.publisher.publish(summary_messages_.build(geometry_.simulator(), stamp, frames_));
}

void Outputs::count(curtain_sim::Statistics& statistics) const {
  statistics.states_sent = state_.sent;
  statistics.meshes_sent = mesh_.sent;
  statistics.markers_sent = markers_.sent;
}

// A viewer that tf2 does not know yet gets full detail; one that was known stays where it was.
curtain::MeshDetail Outputs::meshDetail() {
  if (viewer_frame_.empty()) return detail_;
  const FrameLookup viewer = frames_.lookup(viewer_frame_);
  if (viewer.known) detail_.viewer = viewer.pose.position;
  viewer_error_ = viewer.may_come ? "" : viewer.error;
  if (!viewer_error_.empty()) {
    ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "the frame '" << viewer_frame_ << "' of ~mesh_viewer_frame is not known in '"
                                                        << frames_.world() << "', ~mesh is made for "
                                                        << (detail_.viewer ? "where it was last" : "any viewer") << ": "
                                                        << viewer_error_);
  }
  return detail_;
}

void Outputs::logPlan() {
  if (!plan_rate_.tick()) return;
  ROSCONSOLE_DEFINE_LOCATION(true, ros::console::levels::Debug, ROSCONSOLE_DEFAULT_NAME ".plan");
  if (!__rosconsole_define_location__enabled) {
    plan_.clear();  // whoever turns it on sees it whole
    return;
  }
  curtain::Plan plan = geometry_.simulator().plan();
  if (plan == plan_) return;
  ROS_DEBUG_STREAM_NAMED("plan", "plan at " << geometry_.simulator().time() << " s:\n" << curtain::describe(plan));
  plan_ = std::move(plan);
}

}  // namespace curtain_ros
