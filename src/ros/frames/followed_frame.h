// SPDX-License-Identifier: BSD-3-Clause
//
// A tf2 frame that something follows from frame to frame of the simulation, as Frames::follow() has it. While no
// transform comes the last one counts, for the timeout at most. A static frame is never late.
#pragma once

#include <ros/time.h>

#include <optional>
#include <string>
#include <utility>

#include "ros/frames/frames.h"

namespace curtain_ros {

class FollowedFrame {
 public:
  /// name: of the frame; timeout [s], > 0; parameter: that gives the timeout, for error().
  FollowedFrame(std::string name, double timeout, std::string parameter)
      : name_(std::move(name)), timeout_(timeout), parameter_(std::move(parameter)) {}

  const std::string& name() const { return name_; }

  enum class Standing {
    kFresh,    ///< it has a pose, not older than the timeout
    kWaiting,  ///< it has never been known, but the listener is young: it may come
    kLost      ///< unknown or too old: error() says which
  };
  /// now: of the node's clock, which stamps are compared with; step: as in Following.
  Standing update(Frames& frames, const ros::Time& now, double step);

  /// That it is followed to; none before the first.
  const std::optional<curtain::Pose>& pose() const { return pose_; }
  const ros::Time& stamp() const { return stamp_; }
  /// Older than half of the timeout.
  bool late() const { return age_ > 0.5 * timeout_; }
  const std::string& error() const { return error_; }

 private:
  std::string name_;
  double timeout_;
  std::string parameter_;
  std::optional<curtain::Pose> pose_;
  ros::Time stamp_;   // of the newest transform; zero: static
  ros::Time read_;    // of the pose
  double age_ = 0.0;  // [s]
  std::string error_;
};

}  // namespace curtain_ros
