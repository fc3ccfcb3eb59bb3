// SPDX-License-Identifier: BSD-3-Clause
#include "ros/ties/ties.h"

#include <ros/console.h>

#include <algorithm>
#include <utility>

#include "curtain_sim/GraspGoal.h"
#include "ros/frames/geometry.h"
#include "ros/hands/read_goal.h"
#include "ros/inputs/read_messages.h"
#include "ros/services/control_services.h"
#include "scene/ranges.h"
#include "step/pin_moves.h"

namespace curtain_ros {

using curtain_sim::Attach;
using curtain_sim::Detach;
using curtain_sim::GraspGoal;

namespace {

// How often a call asks for a frame while the listener is young, and the time between [s].
constexpr int kTries = 40;
constexpr double kBetween = 0.05;

// As a goal of ~grasp, but for the nearest node, which the cloth tells. Empty: what is asked for is one thing.
std::string toGoal(const Attach::Request& request, GraspGoal& goal) {
  goal.frame = request.frame;
  goal.place.position = request.point;
  goal.radius = request.radius;
  goal.size = request.size;
  goal.rows = request.rows;
  goal.columns = request.columns;
  goal.stiffness = request.stiffness;
  goal.break_force = request.break_force;
  const bool ball = request.radius != 0.0, nodes = !request.rows.empty() || !request.columns.empty();
  const bool box = request.size.x != 0.0 || request.size.y != 0.0 || request.size.z != 0.0;
  goal.region = ball ? GraspGoal::SPHERE : box ? GraspGoal::BOX : GraspGoal::NODES;
  const int given = (ball ? 1 : 0) + (box ? 1 : 0) + (nodes ? 1 : 0);
  return given > 1 ? "must give one of radius, size and rows with columns, or none of them" : "";
}

}  // namespace

Ties::Ties(const ros::NodeHandle& private_node, double timeout, Surroundings around)
    : timeout_(timeout), around_(std::move(around)), thread_(private_node, 1) {
  attach_ = thread_.node().advertiseService("attach", &Ties::attach, this);
  detach_ = thread_.node().advertiseService("detach", &Ties::detach, this);
  thread_.start();
}

bool Ties::attach(Attach::Request& request, Attach::Response& response) {
  bool answered = false;
  for (int tries = 0; !answered; ++tries) {
    if (tries > 0) ros::WallDuration(kBetween).sleep();
    const bool done = around_.calls.run([&] { answered = tie(request, response) || tries == kTries; });
    if (!done) response.message = kStops;
    answered = answered || !done;
  }
  response.success = response.message.empty();
  return true;
}

// False: the frame is not known yet, and may come.
bool Ties::tie(const Attach::Request& request, Attach::Response& response) {
  curtain::Simulator& simulator = around_.simulator;
  const std::string id = request.id.empty() ? request.frame : request.id;
  GraspGoal goal;
  curtain::GraspParams grasp;
  response.message = curtain::isPlace(toVec3(request.point)) ? toGoal(request, goal)
                                                             : "point: must be 3 times " + curtain::anywhere().text();
  if (!response.message.empty()) return true;
  FollowedFrame frame(goal.frame, timeout_, "~grasp_timeout");
  const FollowedFrame::Standing standing = frame.update(around_.frames, around_.now(), 0.0);
  if (standing != FollowedFrame::Standing::kFresh) {
    response.message = "frame '" + forLog(goal.frame) + "' " +
                       (frame.error().empty() ? "is not known: no transform of it has come" : frame.error());
    return standing == FollowedFrame::Standing::kLost;
  }
  if (goal.region == GraspGoal::NODES && goal.rows.empty() && goal.columns.empty()) {
    const curtain::Pose& pose = *frame.pose();
    const curtain::NodeIndex nearest =
        simulator.nearestNode(pose.position + pose.orientation * toVec3(goal.place.position));
    goal.rows = {nearest.row};
    goal.columns = {nearest.column};
  }
  std::vector<curtain::Problem> problems = toGrasp(goal, id, wholeCloth(simulator.scene()), grasp);
  grasp.frame = *frame.pose();
  if (problems.empty()) problems = simulator.setGrasp(grasp);
  response.message = curtain::describe(problems);
  if (!problems.empty()) return true;
  ties_.push_back({id, std::move(frame)});
  const curtain::GraspState state = *simulator.graspState(id);
  for (const curtain::NodeIndex& node : state.nodes) {
    response.tied_rows.push_back(node.row);
    response.tied_columns.push_back(node.column);
  }
  return true;
}

bool Ties::detach(Detach::Request& request, Detach::Response& response) {
  if (!around_.calls.run([&] { untie(request.id, response); })) response.message = kStops;
  response.success = response.message.empty();
  return true;
}

void Ties::untie(const std::string& id, Detach::Response& response) {
  std::string known;
  bool any = id.empty();
  for (const Tie& tie : ties_) {
    known += (known.empty() ? "'" : ", '") + tie.id + "'";
    any = any || tie.id == id;
  }
  if (!any) {
    response.message =
        "there is no tie '" + forLog(id) + "'" + (known.empty() ? ", nothing is tied" : ", there are " + known);
    return;
  }
  keep([&](const Tie& tie) {
    if (!id.empty() && tie.id != id) return true;
    around_.simulator.releaseGrasp(tie.id);
    return false;
  });
}

template <typename Stays>
void Ties::keep(const Stays& stays) {
  ties_.erase(std::remove_if(ties_.begin(), ties_.end(), [&](Tie& tie) { return !stays(tie); }), ties_.end());
}

void Ties::apply() {
  keep([this](Tie& tie) { return follow(tie); });
}

bool Ties::follow(Tie& tie) {
  const double step = 1.0 / around_.simulator.scene().solver.frame_rate;
  if (tie.frame.update(around_.frames, around_.now(), step) == FollowedFrame::Standing::kFresh) {
    around_.simulator.moveGrasp(tie.id, *tie.frame.pose());
    return true;
  }
  ROS_WARN_STREAM("the tie '" << forLog(tie.id) << "' lets go: frame '" << forLog(tie.frame.name()) << "' "
                              << tie.frame.error());
  around_.simulator.releaseGrasp(tie.id);
  return false;
}

void Ties::update() {
  keep([this](const Tie& tie) {
    const auto state = around_.simulator.graspState(tie.id);
    if (state && state->end == curtain::GraspEnd::kNone) return true;
    if (state) {
      ROS_WARN_STREAM("the tie '" << forLog(tie.id) << "' is torn: the pull of "
                                  << curtain::formatNumber(state->force.norm()) << " N reached its break_force");
      around_.simulator.releaseGrasp(tie.id);
    }
    return false;
  });
}

void Ties::restart() {
  keep([this](const Tie& tie) {
    around_.simulator.releaseGrasp(tie.id);
    return false;
  });
}

}  // namespace curtain_ros
