// SPDX-License-Identifier: BSD-3-Clause
//
// sensor_msgs/CameraInfo to the engine's camera and back. Needs no ROS master.
#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <vector>

#include "sensing/rays.h"

namespace curtain_ros {

/// The camera of a message, as its raw image has it: width, height, K, D. Returns what is wrong: a distortion other
/// than plumb_bob, binning, a region of interest, the second camera of a stereo pair, R or P that are not finite.
/// checkCamera() and cameraRays() check the camera.
std::vector<curtain::Problem> toCamera(const sensor_msgs::CameraInfo& message, curtain::CameraModel& camera);

/// The message of a camera; its header is left alone. The image is rectified where there is no distortion.
void toMessage(const curtain::CameraModel& camera, sensor_msgs::CameraInfo& message);

/// Fills in P, which an uncalibrated camera leaves at zero: that of K.
void completeProjection(sensor_msgs::CameraInfo& message);

}  // namespace curtain_ros
