// SPDX-License-Identifier: BSD-3-Clause
//
// Points, vectors and poses between geometry_msgs and the engine.
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>

#include "curtain_sim/scene.h"

namespace curtain_ros {

template <typename Xyz>
curtain::Vec3 toVec3(const Xyz& v) {
  return curtain::Vec3(v.x, v.y, v.z);
}

template <typename Xyz>
Xyz toXyz(const curtain::Vec3& v) {
  Xyz message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}
inline geometry_msgs::Point toPoint(const curtain::Vec3& point) { return toXyz<geometry_msgs::Point>(point); }
inline geometry_msgs::Vector3 toVector(const curtain::Vec3& vector) { return toXyz<geometry_msgs::Vector3>(vector); }

inline geometry_msgs::Pose toPose(const curtain::Pose& pose) {
  geometry_msgs::Pose message;
  message.position = toPoint(pose.position);
  message.orientation.x = pose.orientation.x();
  message.orientation.y = pose.orientation.y();
  message.orientation.z = pose.orientation.z();
  message.orientation.w = pose.orientation.w();
  return message;
}

/// A point given in a frame, in the frame's parent. frame  pose of the frame in its parent
inline curtain::Vec3 transformPoint(const curtain::Pose& frame, const curtain::Vec3& point) {
  return frame.position + frame.orientation * point;
}

/// The same of a pose.
inline curtain::Pose transformPose(const curtain::Pose& frame, const curtain::Pose& pose) {
  return {transformPoint(frame, pose.position), (frame.orientation * pose.orientation).normalized()};
}

}  // namespace curtain_ros
