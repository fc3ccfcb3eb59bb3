// SPDX-License-Identifier: BSD-3-Clause
//
// Clouds and depth images as messages.
#pragma once

#include <sensor_msgs/Image.h>
#include <sensor_msgs/PointCloud2.h>

#include <vector>

#include "sensing/cloud_point.h"

namespace curtain_ros {

/// A cloud without points: its fields, and what is the same in every message.
sensor_msgs::PointCloud2 emptyCloud();

/// Puts points in, row by row; height times width of them. dense: none of them is NaN.
void fillCloud(const std::vector<curtain::CloudPoint>& points, std::uint32_t height, std::uint32_t width, bool dense,
               sensor_msgs::PointCloud2& cloud);

/// Depths [m] row by row, NaN: none, as depth_image_proc writes it.
void fillDepths(const std::vector<float>& depths, std::uint32_t height, std::uint32_t width, sensor_msgs::Image& image);

}  // namespace curtain_ros
