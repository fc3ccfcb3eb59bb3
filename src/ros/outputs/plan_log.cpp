// SPDX-License-Identifier: BSD-3-Clause
#include "ros/outputs/plan_log.h"

#include <ros/console.h>

#include <cmath>

namespace curtain_ros {

void PlanLog::update(const curtain::Simulator& simulator) {
  if (frames_-- > 0) return;
  frames_ = static_cast<int>(std::lround(simulator.scene().solver.frame_rate));
  ROSCONSOLE_DEFINE_LOCATION(true, ros::console::levels::Debug, ROSCONSOLE_DEFAULT_NAME ".plan");
  if (!__rosconsole_define_location__enabled) {
    last_.clear();  // whoever turns it on sees it whole
    return;
  }
  curtain::Plan plan = simulator.plan();
  if (plan == last_) return;
  ROS_DEBUG_STREAM_NAMED("plan", "plan at " << simulator.time() << " s:\n" << curtain::describe(plan));
  last_ = std::move(plan);
}

}  // namespace curtain_ros
