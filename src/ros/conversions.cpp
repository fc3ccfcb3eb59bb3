// SPDX-License-Identifier: BSD-3-Clause
#include "ros/conversions.h"

#include <cmath>

#include "ros/frames.h"
#include "ros/shown.h"
#include "scene/ranges.h"

namespace curtain_ros {

using curtain::Problem;
using curtain::Vec3;
using curtain_sim::DragForce;
using curtain_sim::WindSource;

namespace {

using Problems = std::vector<Problem>;

template <typename Xyz>
Vec3 toVec3(const Xyz& v) {
  return Vec3(v.x, v.y, v.z);
}

// Beyond these the cloth's own numbers would lose their digits, or leave those of the messages: no wind and no hand is near.
constexpr double kFarthest = 1e9;   // [m], each coordinate
constexpr double kStrongest = 1e6;  // [Pa], [N], [N/m]
constexpr double kLongest = 1e9;    // [s]

using curtain::formatNumber;

void requireWithin(const Vec3& v, double most, const std::string& key, Problems& problems) {
  if (v.cwiseAbs().maxCoeff() <= most && v.allFinite()) return;
  problems.push_back({key, "must be finite and each of it at most " + formatNumber(most) + ", is [" + formatNumber(v.x()) +
                               ", " + formatNumber(v.y()) + ", " + formatNumber(v.z()) + "]"});
}

void requireUpTo(double value, double most, const std::string& key, Problems& problems) {
  if (value >= 0.0 && value <= most) return;
  problems.push_back({key, "must be a number in [0, " + formatNumber(most) + "], is " + formatNumber(value)});
}

double endOf(double lifetime, double time) {
  return lifetime > 0.0 ? time + lifetime : std::numeric_limits<double>::infinity();
}

void requireShort(const std::string& name, const std::string& key, Problems& problems) {
  if (name.size() <= kLongestName) return;
  problems.push_back({key, "must be no longer than " + std::to_string(kLongestName) + " bytes, begins '" +
                               shown(name.substr(0, 20)) + "'"});
}

// Both messages have the same head; each knows its own constants.
template <typename Message>
Problems checkHeadOf(const Message& message) {
  Problems problems;
  requireShort(message.id, "id", problems);
  requireShort(message.header.frame_id, "header.frame_id", problems);
  switch (message.action) {
    case Message::ADD:
    case Message::DELETE:
      if (message.id.empty()) problems.push_back({"id", "must not be empty"});
      break;
    case Message::DELETEALL:
      break;
    default:
      problems.push_back({"action", "must be ADD (0), DELETE (2) or DELETEALL (3), is " +
                                        std::to_string(static_cast<int>(message.action))});
  }
  return problems;
}

}  // namespace

Problems checkHead(const WindSource& message) { return checkHeadOf(message); }
Problems checkHead(const DragForce& message) { return checkHeadOf(message); }

Problems toWind(const WindSource& message, const curtain::Pose& frame, double time, curtain::WindParams& wind) {
  Problems problems;
  const Vec3 position = toVec3(message.pose.position);
  const auto& q = message.pose.orientation;
  Eigen::Quaterniond orientation(q.w, q.x, q.y, q.z);
  requireWithin(position, kFarthest, "pose.position", problems);
  // A quaternion that nobody set is all zero; one this short has no direction left in its digits.
  if (!std::isfinite(orientation.squaredNorm()) || orientation.norm() < 1e-6) {
    problems.push_back({"pose.orientation", "must be finite and not zero, is [" + formatNumber(q.x) + ", " +
                                                formatNumber(q.y) + ", " + formatNumber(q.z) + ", " + formatNumber(q.w) +
                                                "]"});
  }
  requireUpTo(message.lifetime, kLongest, "lifetime", problems);
  requireUpTo(message.correlation_time, kLongest, "correlation_time", problems);
  requireUpTo(message.pressure, kStrongest, "pressure", problems);
  requireUpTo(message.unsteadiness, kStrongest, "unsteadiness", problems);
  if (!problems.empty()) return problems;

  orientation.normalize();
  wind.id = message.id;
  wind.position = transformPoint(frame, position);
  wind.direction = frame.orientation * (orientation * Vec3::UnitX());
  wind.radius = message.radius;
  wind.half_angle = message.half_angle;
  wind.pressure = message.pressure;
  wind.unsteadiness = message.unsteadiness;
  wind.correlation_time =
      message.correlation_time > 0.0 ? message.correlation_time : curtain::WindParams().correlation_time;
  wind.start = time;
  wind.end = endOf(message.lifetime, time);
  return problems;
}

Problems toDrag(const DragForce& message, const curtain::Pose& frame, double time, const curtain::ClothParams& cloth,
                curtain::DragParams& drag) {
  Problems problems;
  drag = curtain::DragParams();
  drag.id = message.id;

  if (message.row == -1 && message.column == -1) {
    const Vec3 point = toVec3(message.point);
    requireWithin(point, kFarthest, "point", problems);
    drag.point = transformPoint(frame, point);
  } else if (message.row < 0 || message.row >= cloth.rows || message.column < 0 || message.column >= cloth.columns) {
    problems.push_back({"row, column", "must be a node of the " + std::to_string(cloth.rows) + " x " +
                                           std::to_string(cloth.columns) + " grid, or -1, -1 with a point; is " +
                                           std::to_string(message.row) + ", " + std::to_string(message.column)});
  } else {
    drag.node = curtain::NodeIndex{message.row, message.column};
  }

  if (message.mode == DragForce::FORCE) {
    const Vec3 force = toVec3(message.force);
    requireWithin(force, kStrongest, "force", problems);
    drag.force = frame.orientation * force;
  } else if (message.mode == DragForce::SPRING) {
    const Vec3 target = toVec3(message.target);
    requireWithin(target, kFarthest, "target", problems);
    requireUpTo(message.stiffness, kStrongest, "stiffness", problems);
    drag.target = transformPoint(frame, target);
    if (message.stiffness > 0.0) drag.stiffness = message.stiffness;
  } else {
    problems.push_back(
        {"mode", "must be FORCE (0) or SPRING (1), is " + std::to_string(static_cast<int>(message.mode))});
  }

  requireUpTo(message.lifetime, kLongest, "lifetime", problems);
  if (!problems.empty()) return problems;

  drag.radius = message.radius;
  drag.start = time;
  drag.end = endOf(message.lifetime, time);
  return problems;
}

geometry_msgs::Point toPoint(const Vec3& point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  message.z = point.z();
  return message;
}

geometry_msgs::Vector3 toVector(const curtain::Vec3& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

void flatten(const std::vector<Vec3>& points, std::vector<float>& out) {
  out.resize(3 * points.size());
  float* to = out.data();
  for (const Vec3& point : points) {
    for (int axis = 0; axis < 3; ++axis) *to++ = static_cast<float>(point[axis]);
  }
}

void flattenFolds(const curtain::FineMeshTopology& topology, const curtain::FineMesh& mesh, std::vector<float>& out) {
  out.clear();
  for (int row = 0; row < topology.rows; ++row) {
    for (int column = 0; column < topology.columns; ++column) {
      if (column % topology.folds == 0) continue;  // first layer
      const Vec3& point = mesh.positions[static_cast<std::size_t>(row) * static_cast<std::size_t>(topology.columns) +
                                         static_cast<std::size_t>(column)];
      for (int axis = 0; axis < 3; ++axis) out.push_back(static_cast<float>(point[axis]));
    }
  }
}

void toMessage(const curtain::Statistics& statistics, curtain_sim::Statistics& message) {
  message.frame = static_cast<std::uint64_t>(statistics.frames);
  message.simulated_time = statistics.time;
  message.substeps_total = static_cast<std::uint64_t>(statistics.substeps);
  message.substeps = static_cast<std::uint32_t>(statistics.substeps_last);
  message.sweeps = static_cast<std::uint32_t>(statistics.sweeps_last);
  message.rejected = static_cast<std::uint64_t>(statistics.rejected);
  message.unsettled = static_cast<std::uint64_t>(statistics.unsettled);
  message.estimates_skipped = static_cast<std::uint64_t>(statistics.estimates_skipped);
  message.longer_substeps = static_cast<std::uint64_t>(statistics.longer_substeps);
  message.unfinished_substeps = static_cast<std::uint64_t>(statistics.unfinished_substeps);
  message.shortened_frames = static_cast<std::uint64_t>(statistics.shortened_frames);
  message.lost_time = statistics.lost_time;
  message.late_frames = static_cast<std::uint64_t>(statistics.late_frames);
  message.asleep = static_cast<std::uint32_t>(statistics.asleep);
  message.wakes = static_cast<std::uint64_t>(statistics.wakes);
  message.warp_stretch = statistics.warp_stretch;
  message.weft_stretch = statistics.weft_stretch;
  message.contacts = static_cast<std::uint32_t>(statistics.contacts);
  message.position_error = statistics.position_error;
  message.penetration_max = statistics.penetration_max;
  message.step_ms = 1e3 * statistics.step_seconds;
  message.step_ms_max = 1e3 * statistics.step_seconds_max;
  message.finite = statistics.finite;
  message.last_resort_substeps = static_cast<std::uint64_t>(statistics.last_resort_substeps);
  message.momentum_cut = statistics.momentum_cut;
  message.obstacles_waited = statistics.obstacles_waited;
  message.stops = static_cast<std::uint64_t>(statistics.stops);
}

}  // namespace curtain_ros
