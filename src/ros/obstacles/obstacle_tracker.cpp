// SPDX-License-Identifier: BSD-3-Clause
#include "ros/obstacles/obstacle_tracker.h"

#include <ros/console.h>

#include "ros/frames/geometry.h"
#include "ros/time/warn_period.h"
#include "scene/ranges.h"

namespace curtain_ros {

ObstacleTracker::ObstacleTracker(const curtain::Scene& scene, double timeout, Frames& frames)
    : timeout_(timeout), frames_(frames) {
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const curtain::ObstacleParams& obstacle = scene.obstacles[i];
    if (frames.isWorld(obstacle.frame)) continue;  // stands where the scene says
    Tracked tracked;
    tracked.index = static_cast<int>(i);
    tracked.offset = obstacle.pose;
    tracked.name = obstacle.name;
    tracked.frame = placeOf(frames.resolve(obstacle.frame));
    Followed& frame = followed_[tracked.frame];
    frame.names += (frame.names.empty() ? "'" : ", '") + obstacle.name + "'";
    frame.obstacles.push_back(tracked_.size());
    tracked_.push_back(tracked);
  }
  if (!tracked_.empty()) frames_.listen();
}

std::size_t ObstacleTracker::placeOf(const std::string& frame) {
  std::size_t place = 0;
  while (place < followed_.size() && followed_[place].health.frame != frame) ++place;
  if (place == followed_.size()) followed_.emplace_back().health.frame = frame;
  return place;
}

void ObstacleTracker::setPresent(Followed& frame, bool present, curtain::Simulator& simulator) const {
  frame.health.present = present;
  for (const std::size_t n : frame.obstacles) simulator.setObstaclePresent(tracked_[n].index, present);
}

void ObstacleTracker::restart(curtain::Simulator& simulator) {
  for (Followed& frame : followed_) {
    frame.health.is_static = false;
    frame.stamp = ros::Time();
    frame.resumed = false;
    setPresent(frame, false, simulator);
  }
}

void ObstacleTracker::resume(const curtain::Simulator& simulator) {
  for (Followed& frame : followed_) {
    frame.health.present = simulator.obstaclePresent(tracked_[frame.obstacles.front()].index);
    frame.resumed = frame.health.present;
  }
}

void ObstacleTracker::update(curtain::Simulator& simulator, const ros::Time& now) {
  // Asked once, before the frames: a message that began while the listener was young would leave out those asked first.
  const bool may_come = frames_.young();
  std::string left_out;
  for (Followed& frame : followed_) {
    const std::string why = follow(frame, simulator, now);
    if (why.empty()) continue;
    left_out += (left_out.empty() ? "" : "; ") + frame.names + ": its frame '" + frame.health.frame + "' " + why;
  }
  // One message for all: throttled ones for each would show only the first.
  if (!left_out.empty() && !may_come) ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "obstacles left out: " << left_out);
}

FrameLookup ObstacleTracker::lookUp(Followed& followed, const Following& by) {
  ObstacleHealth& health = followed.health;
  if (!health.present || followed.resumed) followed.read = ros::Time();  // it will jump
  FrameLookup frame = frames_.follow(health.frame, by, followed.read);
  health.early = frame.ahead > 0.0;
  early_poses_ += health.early ? followed.obstacles.size() : 0;
  if (frame.known) {
    followed.stamp = frame.stamp;
    health.is_static = frame.stamp.isZero();
  }
  health.error = frame.error;
  return frame;
}

std::string ObstacleTracker::follow(Followed& followed, curtain::Simulator& simulator, const ros::Time& now) {
  const FrameLookup frame = lookUp(followed, {now, timeout_, 1.0 / simulator.scene().solver.frame_rate});
  ObstacleHealth& health = followed.health;
  const bool seen = frame.known || health.present;
  if (followed.resumed && followed.stamp.isZero() && !health.is_static) followed.stamp = now;
  health.age = seen && !health.is_static ? (now - followed.stamp).toSec() : 0.0;
  const bool fresh = seen && (health.age <= timeout_ || (followed.resumed && frame.may_come));
  health.late = fresh && health.age > 0.5 * timeout_;
  late_poses_ += health.late ? followed.obstacles.size() : 0;

  if (fresh && frame.known) {
    const bool jump = !health.present || followed.resumed;
    followed.resumed = false;
    if (jump) setPresent(followed, true, simulator);
    for (const std::size_t n : followed.obstacles)
      simulator.setObstaclePose(tracked_[n].index, transformPose(frame.pose, tracked_[n].offset), jump);
    return {};
  }
  if (fresh) return {};  // late: the last pose

  if (health.present) {
    setPresent(followed, false, simulator);
    followed.resumed = false;
    lost_ += static_cast<std::uint32_t>(followed.obstacles.size());
  }
  if (!frame.known) return "is not known in '" + frames_.world() + "': " + health.error;
  return "is " + curtain::formatNumber(health.age) + " s old (~obstacle_timeout is " + curtain::formatNumber(timeout_) +
         " s)";
}

void ObstacleTracker::count(curtain_sim::Statistics& statistics) const {
  statistics.absent_obstacles = 0;
  for (const Followed& frame : followed_)
    statistics.absent_obstacles += frame.health.present ? 0U : static_cast<std::uint32_t>(frame.obstacles.size());
  statistics.late_poses = late_poses_;
  statistics.early_poses = early_poses_;
  statistics.obstacles_lost = lost_;
}

std::vector<ObstacleHealth> ObstacleTracker::health(const curtain::Simulator& simulator) const {
  std::vector<ObstacleHealth> result;
  for (const Tracked& obstacle : tracked_) {
    result.push_back(followed_[obstacle.frame].health);
    result.back().name = obstacle.name;
    result.back().lag = simulator.obstacleLag(obstacle.index);
  }
  return result;
}

}  // namespace curtain_ros
