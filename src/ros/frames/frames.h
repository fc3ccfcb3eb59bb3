// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: where frames are in the world frame, by tf2. Nothing here ever waits. The listener starts when a frame
// is first asked for: a curtain that needs no tf2 costs no tf2.
#pragma once

#include <ros/node_handle.h>
#include <ros/time.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <string>

#include "curtain_sim/scene.h"

namespace curtain_ros {

/// What a look at a frame gave.
struct FrameLookup {
  bool known = false;
  /// Not known, but the listener is so young that the frame may only not have arrived yet: ask again.
  bool may_come = false;
  curtain::Pose pose;  ///< of the frame in the world frame
  ros::Time stamp;     ///< of the transform; zero: static
  std::string error;   ///< why it is not known
};

/// One thread at a time.
class Frames {
 public:
  Frames(const ros::NodeHandle& node, const std::string& world_frame);

  const std::string& world() const { return world_; }

  /// Empty and the world frame's own name, with or without a leading slash.
  bool isWorld(const std::string& frame) const;

  /// Starts listening, if it has not begun.
  void listen();
  bool listening() const { return listener_ != nullptr; }

  /// The frame as tf2 knows it last; the world frame is known without tf2.
  FrameLookup lookup(const std::string& frame) { return lookup(frame, ros::Time(0)); }

  /// The frame as tf2 knows it for a time, interpolated; 0: last.
  FrameLookup lookup(const std::string& frame, const ros::Time& time);

  /// Forgets what moved: for a clock that jumped back. Static frames stay.
  void clear();

 private:
  ros::NodeHandle node_;
  std::string world_;
  std::unique_ptr<tf2_ros::Buffer> buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  ros::SteadyTime listening_since_;
};

}  // namespace curtain_ros
