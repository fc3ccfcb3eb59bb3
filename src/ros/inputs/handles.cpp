// SPDX-License-Identifier: BSD-3-Clause
#include "ros/inputs/handles.h"

#include <visualization_msgs/InteractiveMarkerUpdate.h>

#include <boost/make_shared.hpp>
#include <cmath>

#include "ros/frames/geometry.h"
#include "scene/layers.h"
#include "scene/sources.h"

namespace curtain_ros {

using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::InteractiveMarkerFeedback;
using visualization_msgs::Marker;

namespace {

constexpr int kHandleCount = 5;
constexpr double kFollowRate = 10.0;  // [1/s] of simulated time
constexpr double kHandleSize = 0.06;  // diameter [m]
constexpr double kGraspRadius = 0.1;  // of the cloth pulled [m]
// Rviz repeats itself four times a second while a handle is dragged; silent for longer, it has been closed.
constexpr double kHoldTime = 1.5;  // [s]

InteractiveMarker makeHandle(const std::string& frame, const std::string& name, const curtain::Vec3& position) {
  Marker ball;
  ball.type = Marker::SPHERE;
  ball.pose.orientation.w = 1.0;
  ball.scale.x = ball.scale.y = ball.scale.z = kHandleSize;
  ball.color.r = 1.0F;
  ball.color.g = 0.75F;
  ball.color.b = 0.1F;
  ball.color.a = 1.0F;

  InteractiveMarkerControl control;  // plain dragging moves it in the plane of the view, with shift in depth
  control.name = "pull";
  control.orientation.w = 1.0;
  control.orientation_mode = InteractiveMarkerControl::VIEW_FACING;
  control.interaction_mode = InteractiveMarkerControl::MOVE_3D;
  control.independent_marker_orientation = true;
  control.always_visible = true;
  control.markers.push_back(ball);

  InteractiveMarker handle;
  handle.header.frame_id = frame;
  handle.name = name;
  handle.scale = static_cast<float>(2.0 * kHandleSize);
  handle.pose = toPose({position, Eigen::Quaterniond::Identity()});
  handle.controls.push_back(control);
  return handle;
}

}  // namespace

std::vector<int> handleColumns(const curtain::ClothParams& cloth) {
  const int gaps = cloth.closed ? kHandleCount : kHandleCount - 1;
  const int links = curtain::weftLinkCount(cloth);
  std::vector<int> columns;
  for (int i = 0; i < kHandleCount; ++i) {
    const int column = static_cast<int>(std::lround(static_cast<double>(i) * links / gaps));
    if (column < cloth.columns && (columns.empty() || columns.back() != column)) columns.push_back(column);
  }
  return columns;
}

Handles::Handles(ros::NodeHandle private_node, const NodeParams& params, const curtain::Simulator& simulator,
                 Inputs& inputs)
    : stiffness_(params.handle_stiffness),
      inputs_(inputs),
      rate_(kFollowRate, simulator.scene().solver.frame_rate),
      server_(private_node.resolveName("handles")) {
  std::vector<int> columns;
  for (const curtain::Layers::Layer& layer : curtain::Layers(simulator.scene())) {
    for (const int column : handleColumns(*layer.cloth)) columns.push_back(layer.first + column);
  }
  for (const int column : columns) {
    const Handle handle{"handle_" + std::to_string(column), {simulator.rows() - 1, column}};
    handles_.push_back(handle);
    server_.insert(
        makeHandle(params.world_frame, handle.name, simulator.position(handle.node)),
        [this, handle](const InteractiveMarkerFeedback::ConstPtr& feedback) { onFeedback(handle, *feedback); });
  }
  server_.applyChanges();
  update_watch_ = private_node.advertise<visualization_msgs::InteractiveMarkerUpdate>("handles/update", 100);
}

void Handles::setFrameRate(double frame_rate) { rate_.setRate(kFollowRate, frame_rate); }

void Handles::update(const curtain::Simulator& simulator) {
  if (!rate_.tick() || update_watch_.getNumSubscribers() == 0) return;
  if (!touched_.exchange(false) && shown_ == simulator.revision()) return;
  shown_ = simulator.revision();
  for (const Handle& handle : handles_) {
    if (curtain::findById(simulator.drags(), handle.name) != nullptr) {  // dragged
      touched_ = true;
      continue;
    }
    server_.setPose(handle.name, toPose({simulator.position(handle.node), Eigen::Quaterniond::Identity()}));
  }
  server_.applyChanges();
}

void Handles::onFeedback(const Handle& handle, const InteractiveMarkerFeedback& feedback) {
  touched_ = true;
  const auto drag = boost::make_shared<curtain_sim::DragForce>();
  drag->header = feedback.header;
  drag->id = handle.name;
  switch (feedback.event_type) {
    case InteractiveMarkerFeedback::MOUSE_UP:
      drag->action = curtain_sim::DragForce::DELETE;
      break;
    case InteractiveMarkerFeedback::MOUSE_DOWN:
    case InteractiveMarkerFeedback::POSE_UPDATE:
    case InteractiveMarkerFeedback::KEEP_ALIVE:
      drag->action = curtain_sim::DragForce::ADD;
      drag->row = handle.node.row;
      drag->column = handle.node.column;
      drag->mode = curtain_sim::DragForce::SPRING;
      drag->target = feedback.pose.position;
      drag->stiffness = stiffness_;
      drag->radius = kGraspRadius;
      drag->lifetime = kHoldTime;
      break;
    default:
      return;  // menus, buttons
  }
  inputs_.post(drag);
}

}  // namespace curtain_ros
