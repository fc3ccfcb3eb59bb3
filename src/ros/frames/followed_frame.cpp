// SPDX-License-Identifier: BSD-3-Clause
#include "ros/frames/followed_frame.h"

#include "scene/ranges.h"

namespace curtain_ros {

FollowedFrame::Standing FollowedFrame::update(Frames& frames, const ros::Time& now, double step) {
  const FrameLookup found = frames.follow(name_, {now, timeout_, step}, read_);
  if (found.known) {
    pose_ = found.pose;
    stamp_ = found.stamp;
  } else if (!pose_) {
    error_ = "is not known in '" + frames.world() + "': " + found.error;
    return found.may_come ? Standing::kWaiting : Standing::kLost;
  }
  age_ = stamp_.isZero() ? 0.0 : (now - stamp_).toSec();
  if (age_ <= timeout_) return Standing::kFresh;
  error_ = "has not been heard of for " + curtain::formatNumber(age_) + " s (" + parameter_ + " is " +
           curtain::formatNumber(timeout_) + " s)";
  return Standing::kLost;
}

}  // namespace curtain_ros
