// SPDX-License-Identifier: BSD-3-Clause
#include "ros/obstacle_tracker.h"

#include <ros/console.h>

#include <algorithm>

namespace curtain_ros {

namespace {
constexpr double kWarnPeriod = 5.0;  // [s] between warnings
}

ObstacleTracker::ObstacleTracker(const curtain::Scene& scene, double timeout, Frames& frames)
    : timeout_(timeout), frames_(frames) {
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const curtain::ObstacleParams& obstacle = scene.obstacles[i];
    if (frames.isWorld(obstacle.frame)) continue;  // stands where the scene says
    Tracked tracked;
    tracked.index = static_cast<int>(i);
    tracked.name = obstacle.name;
    tracked.frame = obstacle.frame;
    tracked.offset = obstacle.pose;
    tracked_.push_back(tracked);
  }
  if (!tracked_.empty()) frames_.listen();
}

void ObstacleTracker::restart(curtain::Simulator& simulator) {
  for (Tracked& obstacle : tracked_) {
    obstacle.present = false;
    obstacle.is_static = false;
    obstacle.stamp = ros::Time();
    simulator.setObstaclePresent(obstacle.index, false);
  }
}

void ObstacleTracker::update(curtain::Simulator& simulator, const ros::Time& now) {
  for (Tracked& obstacle : tracked_) follow(obstacle, simulator, now);
}

void ObstacleTracker::follow(Tracked& obstacle, curtain::Simulator& simulator, const ros::Time& now) {
  const FrameLookup frame = frames_.lookup(obstacle.frame);
  if (frame.known) {
    obstacle.stamp = frame.stamp;
    obstacle.is_static = frame.stamp.isZero();
  }
  const bool seen = frame.known || obstacle.present;
  const double age = (now - obstacle.stamp).toSec();
  const bool fresh = seen && (obstacle.is_static || age <= timeout_);

  if (fresh && frame.known) {
    const bool jump = !obstacle.present;
    if (jump) simulator.setObstaclePresent(obstacle.index, true);
    simulator.setObstaclePose(obstacle.index, compose(frame.pose, obstacle.offset), jump);
    obstacle.present = true;
    return;
  }
  if (fresh) return;  // late: the last pose

  if (obstacle.present) {
    simulator.setObstaclePresent(obstacle.index, false);
    obstacle.present = false;
  }
  if (frame.may_come) return;  // the listener has just begun: too early to complain
  if (frame.known) {
    ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "obstacle '" << obstacle.name << "' left out: its frame '" << obstacle.frame
                                                       << "' is " << age << " s old (~obstacle_timeout is " << timeout_
                                                       << " s)");
  } else {
    ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "obstacle '" << obstacle.name << "' left out: its frame '" << obstacle.frame
                                                       << "' is not known in '" << frames_.world()
                                                       << "': " << frame.error);
  }
}

std::uint32_t ObstacleTracker::absent() const {
  return static_cast<std::uint32_t>(
      std::count_if(tracked_.begin(), tracked_.end(), [](const Tracked& o) { return !o.present; }));
}

}  // namespace curtain_ros
