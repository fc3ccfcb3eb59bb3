// SPDX-License-Identifier: BSD-3-Clause
#include "ros/sensors/sensor_messages.h"

#include <sensor_msgs/image_encodings.h>

#include <cstddef>
#include <cstring>
#include <string>

namespace curtain_ros {

using curtain::CloudPoint;
using sensor_msgs::PointField;

sensor_msgs::PointCloud2 emptyCloud() {
  sensor_msgs::PointCloud2 cloud;
  const auto add = [&cloud](const std::string& name, std::size_t offset, std::uint8_t type) {
    PointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(offset);
    field.datatype = type;
    field.count = 1;
    cloud.fields.push_back(field);
  };
  add("x", offsetof(CloudPoint, x), PointField::FLOAT32);
  add("y", offsetof(CloudPoint, y), PointField::FLOAT32);
  add("z", offsetof(CloudPoint, z), PointField::FLOAT32);
  add("normal_x", offsetof(CloudPoint, normal_x), PointField::FLOAT32);
  add("normal_y", offsetof(CloudPoint, normal_y), PointField::FLOAT32);
  add("normal_z", offsetof(CloudPoint, normal_z), PointField::FLOAT32);
  add("node", offsetof(CloudPoint, node), PointField::INT32);
  add("u", offsetof(CloudPoint, u), PointField::FLOAT32);
  add("v", offsetof(CloudPoint, v), PointField::FLOAT32);
  add("speed", offsetof(CloudPoint, speed), PointField::FLOAT32);
  cloud.point_step = sizeof(CloudPoint);
  return cloud;
}

namespace {

// Bytes as they lie in memory: little-endian machines alone are known to have ROS 1.
template <typename Value>
void copyBytes(const std::vector<Value>& values, std::vector<std::uint8_t>& bytes) {
  bytes.resize(values.size() * sizeof(Value));
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
}

template <typename Value>
void fill(const std::vector<Value>& values, std::uint32_t height, std::uint32_t width, const std::string& encoding,
          sensor_msgs::Image& image) {
  image.height = height;
  image.width = width;
  image.encoding = encoding;
  image.step = width * static_cast<std::uint32_t>(sizeof(Value));
  copyBytes(values, image.data);
}

}  // namespace

void fillCloud(const std::vector<CloudPoint>& points, std::uint32_t height, std::uint32_t width, bool dense,
               sensor_msgs::PointCloud2& cloud) {
  cloud.height = height;
  cloud.width = width;
  cloud.row_step = width * cloud.point_step;
  cloud.is_dense = static_cast<std::uint8_t>(dense);
  copyBytes(points, cloud.data);
}

void fillImage(const std::vector<float>& depths, std::uint32_t height, std::uint32_t width, sensor_msgs::Image& image) {
  fill(depths, height, width, sensor_msgs::image_encodings::TYPE_32FC1, image);
}
void fillImage(const std::vector<std::uint16_t>& labels, std::uint32_t height, std::uint32_t width,
               sensor_msgs::Image& image) {
  fill(labels, height, width, sensor_msgs::image_encodings::TYPE_16UC1, image);
}
void fillImage(const std::vector<std::int32_t>& nodes, std::uint32_t height, std::uint32_t width,
               sensor_msgs::Image& image) {
  fill(nodes, height, width, sensor_msgs::image_encodings::TYPE_32SC1, image);
}

}  // namespace curtain_ros
