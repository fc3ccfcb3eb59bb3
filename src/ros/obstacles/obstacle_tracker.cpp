// SPDX-License-Identifier: BSD-3-Clause
#include "ros/obstacles/obstacle_tracker.h"

#include <ros/console.h>

#include <algorithm>

#include "ros/frames/geometry.h"
#include "scene/ranges.h"

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
    tracked.offset = obstacle.pose;
    tracked.health.name = obstacle.name;
    tracked.health.frame = obstacle.frame;
    tracked_.push_back(tracked);
  }
  if (!tracked_.empty()) frames_.listen();
}

void ObstacleTracker::restart(curtain::Simulator& simulator) {
  for (Tracked& obstacle : tracked_) {
    obstacle.health.present = false;
    obstacle.health.is_static = false;
    obstacle.stamp = ros::Time();
    obstacle.resumed = false;
    simulator.setObstaclePresent(obstacle.index, false);
  }
}

void ObstacleTracker::resume(const curtain::Simulator& simulator) {
  for (Tracked& obstacle : tracked_) {
    obstacle.health.present = simulator.obstaclePresent(obstacle.index);
    obstacle.resumed = obstacle.health.present;
  }
}

void ObstacleTracker::update(curtain::Simulator& simulator, const ros::Time& now) {
  std::string left_out;
  for (Tracked& obstacle : tracked_) {
    const std::string why = follow(obstacle, simulator, now);
    if (why.empty()) continue;
    const ObstacleHealth& health = obstacle.health;
    left_out += (left_out.empty() ? "'" : "; '") + health.name + "': its frame '" + health.frame + "' " + why;
  }
  // One message for all: throttled ones for each would show only the first.
  if (!left_out.empty()) ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "obstacles left out: " << left_out);
}

FrameLookup ObstacleTracker::lookUp(Tracked& obstacle, const ros::Time& now) {
  ObstacleHealth& health = obstacle.health;
  FrameLookup frame = frames_.lookup(health.frame);
  const double ahead = frame.known && !frame.stamp.isZero() ? (frame.stamp - now).toSec() : 0.0;
  health.early = ahead > timeout_;
  if (health.early) {
    ++early_poses_;
    frame = frames_.lookup(health.frame, now);
    if (!frame.known) frame.error = "its transform is " + std::to_string(ahead) + " s ahead of the clock";
  }
  if (frame.known) {
    obstacle.stamp = frame.stamp;
    health.is_static = frame.stamp.isZero();
  }
  health.error = frame.error;
  return frame;
}

std::string ObstacleTracker::follow(Tracked& obstacle, curtain::Simulator& simulator, const ros::Time& now) {
  const FrameLookup frame = lookUp(obstacle, now);
  ObstacleHealth& health = obstacle.health;
  const bool seen = frame.known || health.present;
  if (obstacle.resumed && obstacle.stamp.isZero() && !health.is_static) obstacle.stamp = now;
  health.age = seen && !health.is_static ? (now - obstacle.stamp).toSec() : 0.0;
  const bool fresh = seen && (health.age <= timeout_ || (obstacle.resumed && frame.may_come));
  health.late = fresh && health.age > 0.5 * timeout_;
  late_poses_ += health.late ? 1 : 0;

  if (fresh && frame.known) {
    const bool jump = !health.present || obstacle.resumed;
    obstacle.resumed = false;
    if (jump) simulator.setObstaclePresent(obstacle.index, true);
    simulator.setObstaclePose(obstacle.index, transformPose(frame.pose, obstacle.offset), jump);
    health.present = true;
    return {};
  }
  if (fresh) return {};  // late: the last pose

  if (health.present) {
    simulator.setObstaclePresent(obstacle.index, false);
    health.present = false;
    obstacle.resumed = false;
    ++lost_;
  }
  if (frame.may_come) return {};  // the listener is young: too early to warn
  if (!frame.known) return "is not known in '" + frames_.world() + "': " + health.error;
  return "is " + curtain::formatNumber(health.age) + " s old (~obstacle_timeout is " + curtain::formatNumber(timeout_) +
         " s)";
}

void ObstacleTracker::count(curtain_sim::Statistics& statistics) const {
  statistics.absent_obstacles = static_cast<std::uint32_t>(
      std::count_if(tracked_.begin(), tracked_.end(), [](const Tracked& o) { return !o.health.present; }));
  statistics.late_poses = late_poses_;
  statistics.early_poses = early_poses_;
  statistics.obstacles_lost = lost_;
}

std::vector<ObstacleHealth> ObstacleTracker::health() const {
  std::vector<ObstacleHealth> result;
  for (const Tracked& obstacle : tracked_) result.push_back(obstacle.health);
  return result;
}

}  // namespace curtain_ros
