// SPDX-License-Identifier: BSD-3-Clause
#include "ros/frames/frames.h"

#include <tf2/exceptions.h>

#include <algorithm>

#include "scene/ranges.h"

namespace curtain_ros {

namespace {

// Static and slow (10 Hz) frames reach a new listener within this time; after it an unknown name is reported.
const ros::WallDuration kYouth(1.0);

// [m] A frame further away is not taken: sums with its position would lose the cloth's digits.
constexpr double kFarthest = 1e9;

// What is behind its frame goes on by this many times its speed.
constexpr double kFastest = 2.0;

// Or by this share of the way, if that is more: on a computer that makes one frame in three it stays behind by 0.4 s.
constexpr double kMinMadeUp = 1.0 / 8.0;

std::string withoutSlash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

}  // namespace

Frames::Frames(const ros::NodeHandle& node, const std::string& world_frame)
    : node_(node), world_(withoutSlash(world_frame)) {}

std::string Frames::resolve(const std::string& frame) const { return frame.empty() ? world_ : withoutSlash(frame); }

bool Frames::isWorld(const std::string& frame) const { return frame.empty() || withoutSlash(frame) == world_; }

void Frames::listen() {
  if (listener_) return;
  buffer_ = std::make_unique<tf2_ros::Buffer>();
  listener_ = std::make_unique<tf2_ros::TransformListener>(*buffer_, node_, true, ros::TransportHints().tcpNoDelay());
  listening_since_ = ros::SteadyTime::now();
}

FrameLookup Frames::lookup(const std::string& frame, const ros::Time& time) {
  FrameLookup result;
  if (isWorld(frame)) {
    result.known = true;
    return result;
  }
  listen();
  try {
    const geometry_msgs::TransformStamped t = buffer_->lookupTransform(world_, withoutSlash(frame), time);
    const auto& p = t.transform.translation;
    const auto& q = t.transform.rotation;
    result.pose.position = curtain::Vec3(p.x, p.y, p.z);
    result.pose.orientation = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
    result.stamp = t.header.stamp;
    result.known =
        result.pose.position.cwiseAbs().maxCoeff() <= kFarthest && result.pose.orientation.coeffs().allFinite();
    if (!result.known) result.error = "its transform is not finite, or further than 1.0e9 m away";
  } catch (const tf2::TransformException& e) {
    result.error = e.what();
    result.may_come = young();
  }
  return result;
}

FrameLookup Frames::follow(const std::string& frame, const Following& by, ros::Time& read) {
  FrameLookup found = lookup(frame);
  if (!found.known || found.stamp.isZero()) return found;
  const double ahead = (found.stamp - by.now).toSec();
  if (ahead > by.timeout) {
    found = lookup(frame, by.now);
    found.ahead = ahead;
    if (!found.known) found.error = "its transform is " + curtain::formatNumber(ahead) + " s ahead of the clock";
    read = by.now;
    return found;
  }
  const double behind = read.isZero() ? 0.0 : (found.stamp - read).toSec();
  const double taken = std::max(kFastest * by.step, kMinMadeUp * behind);
  read = found.stamp;
  if (by.step > 0.0 && behind > taken) {
    const ros::Time on_the_way = found.stamp - ros::Duration(behind - taken);
    const FrameLookup older = lookup(frame, on_the_way);
    if (older.known) {
      found.pose = older.pose;
      read = on_the_way;
    }
  }
  return found;
}

bool Frames::young() const { return listener_ && ros::SteadyTime::now() - listening_since_ < kYouth; }

void Frames::clear() {
  if (buffer_) buffer_->clear();
}

}  // namespace curtain_ros
