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

/// An image of single values, row by row: depths [m] (NaN: none, as depth_image_proc writes it), labels, nodes.
void fillImage(const std::vector<float>& depths, std::uint32_t height, std::uint32_t width, sensor_msgs::Image& image);
void fillImage(const std::vector<std::uint16_t>& labels, std::uint32_t height, std::uint32_t width,
               sensor_msgs::Image& image);  ///< as above
void fillImage(const std::vector<std::int32_t>& nodes, std::uint32_t height, std::uint32_t width,
               sensor_msgs::Image& image);  ///< as above

}  // namespace curtain_ros
