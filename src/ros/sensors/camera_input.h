// SPDX-License-Identifier: BSD-3-Clause
//
// camera_info: the camera to look through, as messages tell. Drivers send the same one with every image; rays are made
// only of another one, which takes a while (0.4 s for 2048 x 2048 pixels and a distortion), on the sensor's own thread.
#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/CameraInfo.h>

#include <optional>
#include <string>
#include <vector>

#include "ros/inputs/inputs.h"
#include "ros/inputs/mailbox.h"
#include "ros/sensors/worker.h"
#include "sensing/rays.h"

namespace curtain_ros {

/// Simulation thread only.
class CameraInput {
 public:
  /// Subscribes camera_info in the node's namespace. The others must outlive this.
  CameraInput(ros::NodeHandle& node, Inputs& inputs, Worker& worker);

  /// Takes the newest message, once a frame's time, and goes on as work() does. A bad one is dropped and counted, and
  /// the camera stays as it was.
  void apply();

  /// Takes the rays that were made, and begins to make others that are wanted, where the worker is free. True: it has
  /// begun.
  bool work();

  /// What was told of the camera, its header's stamp apart; none: no good one has come.
  const std::optional<sensor_msgs::CameraInfo>& info() const { return info_; }

  /// Its rays, once for each camera.
  std::optional<curtain::RayGrid> newRays();

  std::string topic() const { return subscriber_.getTopic(); }

 private:
  struct Camera {
    curtain::CameraModel model;
    sensor_msgs::CameraInfo message;
  };

  void receive(const sensor_msgs::CameraInfo& message);
  void settle();

  Inputs& inputs_;
  Worker& worker_;
  std::optional<sensor_msgs::CameraInfo> info_;
  curtain::CameraModel model_;            // of info_
  std::optional<curtain::RayGrid> rays_;  // of model_; none: taken
  std::optional<Camera> next_;            // its rays are to be made
  std::optional<Camera> making_;          // are being made
  curtain::CameraModel refused_;          // last one without rays, and why
  std::vector<curtain::Problem> refused_for_;
  // The worker's while it makes them.
  curtain::RayGrid made_;
  std::vector<curtain::Problem> problems_;
  Mailbox<sensor_msgs::CameraInfo::ConstPtr> letters_;
  ros::Subscriber subscriber_;  // last: it posts to the mailbox
};

}  // namespace curtain_ros
