// SPDX-License-Identifier: BSD-3-Clause
//
// A point of a cloud, laid out as in the message: its bytes are copied there.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>

namespace curtain {

struct CloudPoint {
  static constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

  float x = kNone, y = kNone, z = kNone;                       ///< [m]; NaN: nothing is seen there
  float normal_x = kNone, normal_y = kNone, normal_z = kNone;  ///< unit; a sensor's: towards it
  // Of the cloth; -1: what is seen is none. Numbers, so that filters for a range pick the cloth, and means stay
  // numbers.
  std::int32_t node = -1;      ///< nearest node, row * columns + column
  float u = -1.0F, v = -1.0F;  ///< [m] on the flat cloth
  float speed = -1.0F;         ///< [m/s]

  void setPosition(const Eigen::Vector3f& p) { x = p.x(), y = p.y(), z = p.z(); }
  void setNormal(const Eigen::Vector3f& n) { normal_x = n.x(), normal_y = n.y(), normal_z = n.z(); }
};
static_assert(sizeof(CloudPoint) == 40, "its fields follow each other without gaps");

}  // namespace curtain
