// SPDX-License-Identifier: BSD-3-Clause
//
// Where the rays of a sensor go: from its origin through the pixels of a camera, or along the rings of a lidar.
//
//   camera (REP 103, optical frame)          lidar
//     x right, y down, z forward               x forward, y left, z up
//     directions have z = 1: a ray's           directions have length 1: its parameter
//     parameter is the depth                   is the distance
#pragma once

#include <array>
#include <vector>

#include "curtain_sim/scene.h"
#include "sensing/sensor_params.h"

namespace curtain {

/// Directions of a sensor's rays, row by row.
struct RayGrid {
  int width = 0;
  int height = 0;
  std::vector<float> x, y, z;  ///< shape [width * height]

  std::size_t size() const { return x.size(); }
};

/// A pinhole camera with the distortion "plumb_bob" (Brown 1971, as sensor_msgs/CameraInfo has it).
struct CameraModel {
  int width = 0, height = 0;           ///< [pixel]
  double fx = 0.0, fy = 0.0;           ///< [pixel]
  double cx = 0.0, cy = 0.0;           ///< [pixel]; pixel centres are whole numbers
  std::array<double, 5> distortion{};  ///< k1, k2, p1, p2, k3
};

bool operator==(const CameraModel& a, const CameraModel& b);

/// The camera of valid parameters.
CameraModel cameraModel(const CameraParams& params);

/// What is wrong with a camera's numbers by themselves, by its fields: sizes, focal lengths, what is not finite.
std::vector<Problem> checkCamera(const CameraModel& camera);

/// The rays of a camera. problems: what checkCamera() says, or a distortion without an inverse at some pixel; then the
/// rays are not valid.
RayGrid cameraRays(const CameraModel& camera, std::vector<Problem>& problems);

/// The rays of a lidar with valid parameters: a row a ring, the highest first; columns from -pi on, turning to the
/// left.
RayGrid lidarRays(const LidarParams& lidar);

}  // namespace curtain
