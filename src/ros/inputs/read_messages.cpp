// SPDX-License-Identifier: BSD-3-Clause
#include "ros/inputs/read_messages.h"

#include <cmath>
#include <limits>

#include "ros/frames/geometry.h"
#include "scene/range_checker.h"

namespace curtain_ros {

using curtain::Vec3;
using curtain_sim::DragForce;
using curtain_sim::WindSource;

namespace {

using Problems = std::vector<curtain::Problem>;

// Larger numbers would cost the cloth's own numbers their digits.
const curtain::Range kPlace = curtain::between(-1e9, 1e9);     // [m]
const curtain::Range kForce = curtain::between(-1e6, 1e6);     // [N]
const curtain::Range kStiffness = curtain::between(0.0, 1e6);  // [N/m]
const curtain::Range kTime = curtain::between(0.0, 1e9);       // [s]

double endOf(double lifetime, double time) {
  return lifetime > 0.0 ? time + lifetime : std::numeric_limits<double>::infinity();
}

// Both messages have the same head; each knows its own constants.
template <typename Message>
Problems checkHeadOf(const Message& message) {
  Problems problems;
  const auto requireShort = [&problems](const std::string& name, const char* key) {
    if (name.size() <= kLongestName) return;
    problems.push_back(
        {key, "must be no longer than " + std::to_string(kLongestName) + " bytes, is " + forLog(name, 20)});
  };
  requireShort(message.id, "id");
  requireShort(message.header.frame_id, "header.frame_id");
  if (message.action == Message::ADD || message.action == Message::DELETE) {
    if (message.id.empty()) problems.push_back({"id", "must not be empty"});
  } else if (message.action != Message::DELETEALL) {
    problems.push_back(
        {"action", "must be ADD (0), DELETE (2) or DELETEALL (3), is " + std::to_string(message.action)});
  }
  return problems;
}

}  // namespace

std::string forLog(const std::string& text, std::size_t longest) {
  std::string result = text.substr(0, longest);
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  }
  if (text.size() > longest) result += "… (" + std::to_string(text.size()) + " bytes)";
  return result;
}

Problems checkHead(const WindSource& message) { return checkHeadOf(message); }
Problems checkHead(const DragForce& message) { return checkHeadOf(message); }

Problems toWind(const WindSource& message, const curtain::Pose& frame, double time, curtain::WindParams& wind) {
  curtain::ProblemLog log;
  curtain::RangeChecker check("", log);
  const Vec3 position = toVec3(message.pose.position);
  const auto& q = message.pose.orientation;
  const Eigen::Quaterniond orientation(q.w, q.x, q.y, q.z);
  check.vector("pose.position", position, kPlace);
  // A shorter quaternion (all zero: nobody set it) has no digits left for a direction.
  if (!std::isfinite(orientation.squaredNorm()) || orientation.norm() < 1e-6) {
    log.add("pose.orientation",
            "must be finite and not zero, has the norm " + curtain::formatNumber(orientation.norm()));
  }
  check.number("lifetime", message.lifetime, kTime);
  if (message.profile != WindSource::UNIFORM && message.profile != WindSource::RING_JET) {
    log.add("profile", "must be UNIFORM (0) or RING_JET (1), is " + std::to_string(message.profile));
  }
  if (!log.problems().empty()) return log.problems();

  wind.id = message.id;
  placeWind(message, frame, wind);
  wind.radius = message.radius;
  wind.half_angle = message.half_angle;
  wind.pressure = message.pressure;
  wind.unsteadiness = message.unsteadiness;
  wind.shadow = message.shadow != 0;
  wind.profile =
      message.profile == WindSource::RING_JET ? curtain::WindProfile::kRingJet : curtain::WindProfile::kUniform;
  wind.correlation_time =
      message.correlation_time == 0.0 ? curtain::WindParams().correlation_time : message.correlation_time;
  wind.start = time;
  wind.end = endOf(message.lifetime, time);
  return {};
}

void placeWind(const WindSource& message, const curtain::Pose& frame, curtain::WindParams& wind) {
  const auto& q = message.pose.orientation;
  const Eigen::Quaterniond orientation(q.w, q.x, q.y, q.z);
  wind.position = transformPoint(frame, toVec3(message.pose.position));
  wind.direction = frame.orientation * (orientation.normalized() * Vec3::UnitX());
}

Problems toDrag(const DragForce& message, const curtain::Pose& frame, double time, const curtain::ClothParams& cloth,
                curtain::DragParams& drag) {
  curtain::ProblemLog log;
  curtain::RangeChecker check("", log);
  drag = curtain::DragParams();
  drag.id = message.id;
  if (message.row == -1 && message.column == -1) {
    check.vector("point", toVec3(message.point), kPlace);
    drag.point = transformPoint(frame, toVec3(message.point));
  } else if (message.row < 0 || message.row >= cloth.rows || message.column < 0 || message.column >= cloth.columns) {
    log.add("row, column", "must be a node of the " + std::to_string(cloth.rows) + " x " +
                               std::to_string(cloth.columns) + " grid, or -1, -1 with a point; is " +
                               std::to_string(message.row) + ", " + std::to_string(message.column));
  } else {
    drag.node = curtain::NodeIndex{message.row, message.column};
  }
  if (message.mode == DragForce::FORCE) {
    check.vector("force", toVec3(message.force), kForce);
    drag.force = frame.orientation * toVec3(message.force);
  } else if (message.mode == DragForce::SPRING) {
    check.vector("target", toVec3(message.target), kPlace);
    check.number("stiffness", message.stiffness, kStiffness);
    drag.target = transformPoint(frame, toVec3(message.target));
    if (message.stiffness > 0.0) drag.stiffness = message.stiffness;
  } else {
    log.add("mode", "must be FORCE (0) or SPRING (1), is " + std::to_string(message.mode));
  }
  check.number("lifetime", message.lifetime, kTime);
  drag.radius = message.radius;
  drag.start = time;
  drag.end = endOf(message.lifetime, time);
  return log.problems();
}

}  // namespace curtain_ros
