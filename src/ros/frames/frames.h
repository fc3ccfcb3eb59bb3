// SPDX-License-Identifier: BSD-3-Clause
//
// Poses of tf2 frames in the world frame. Nothing here waits. The listener starts when a frame is first asked for: a
// curtain that needs no tf2 costs no tf2.
//
// Who follows a frame reads it once a frame of the simulation, at its newest transform. Where time was lost, because
// frames were dropped or transforms came late, that one can be far along the way: taken at once, a hand that draws a
// curtain by 0.4 m/s would throw it. So what moves is read along its way, at twice its speed at most until it is made
// up for; by more than that only where it is far behind.
#pragma once

#include <ros/node_handle.h>
#include <ros/time.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <memory>
#include <string>

#include "curtain_sim/scene.h"

namespace curtain_ros {

/// What a lookup gave.
struct FrameLookup {
  bool known = false;
  /// Not known, but the listener is so young that the frame may still arrive: ask again.
  bool may_come = false;
  curtain::Pose pose;  ///< of the frame in the world frame
  ros::Time stamp;     ///< of the transform; zero: static
  std::string error;   ///< why it is not known
  double ahead = 0.0;  ///< of now, more than the timeout [s]; Frames::follow()
};

/// How a frame is followed.
struct Following {
  ros::Time now;         ///< of the node's clock, which stamps are compared with
  double timeout = 0.0;  ///< [s], > 0
  double step = 0.0;     ///< length of the simulation's frames [s]; 0: always the newest transform
};

/// One thread at a time.
class Frames {
 public:
  Frames(const ros::NodeHandle& node, const std::string& world_frame);

  const std::string& world() const { return world_; }

  /// Its name as tf2 has it: without a leading slash; of an empty one the world frame's.
  std::string resolve(const std::string& frame) const;

  /// Empty and the world frame's own name, with or without a leading slash.
  bool isWorld(const std::string& frame) const;

  /// Starts listening, if it has not begun.
  void listen();

  /// The frame at a time, interpolated; 0: the latest transform. The world frame is known without tf2.
  FrameLookup lookup(const std::string& frame, const ros::Time& time = ros::Time(0));

  /// The frame for who reads it once a frame of the simulation; the stamp is the newest transform's. One that is ahead
  /// of the clock by more than the timeout is that of now.
  ///   read  in, out: of the pose that was taken; zero: none yet
  FrameLookup follow(const std::string& frame, const Following& by, ros::Time& read);

  /// Whether it listens for so short a time that frames unknown by now may still arrive.
  bool young() const;

  /// Drops all transforms but static ones: for a clock that jumped back.
  void clear();

 private:
  ros::NodeHandle node_;
  std::string world_;
  std::unique_ptr<tf2_ros::Buffer> buffer_;
  std::unique_ptr<tf2_ros::TransformListener> listener_;
  ros::SteadyTime listening_since_;
};

}  // namespace curtain_ros
