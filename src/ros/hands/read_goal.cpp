// SPDX-License-Identifier: BSD-3-Clause
#include "ros/hands/read_goal.h"

#include <limits>

#include "ros/frames/geometry.h"
#include "ros/inputs/read_messages.h"
#include "scene/checks.h"
#include "scene/range_checker.h"

namespace curtain_ros {

using curtain_sim::GraspGoal;

namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

double orNone(double value) { return value == 0.0 ? kNone : value; }

void readNodes(const GraspGoal& goal, const curtain::ClothParams& cloth, curtain::ProblemLog& log,
               curtain::GraspParams& grasp) {
  if (goal.rows.size() != goal.columns.size()) {
    log.add("columns", "must have as many entries as rows, " + std::to_string(goal.rows.size()) + ", has " +
                           std::to_string(goal.columns.size()));
    return;
  }
  for (std::size_t k = 0; k < goal.rows.size(); ++k) {
    grasp.nodes.push_back({goal.rows[k], goal.columns[k]});
    curtain::checkNodeOnGrid(grasp.nodes.back(), cloth, curtain::itemKey("nodes", k), log);
  }
}

// Nobody set an orientation of zeros.
curtain::Rotation rotationOf(const geometry_msgs::Quaternion& q) {
  const curtain::Rotation rotation(q.w, q.x, q.y, q.z);
  return rotation.coeffs().isZero(0.0) ? curtain::Rotation(1.0, 0.0, 0.0, 0.0) : rotation;
}

}  // namespace

std::vector<curtain::Problem> toGrasp(const GraspGoal& goal, const std::string& id, const curtain::ClothParams& cloth,
                                      curtain::GraspParams& grasp) {
  curtain::ProblemLog log;
  curtain::RangeChecker check("", log);
  grasp = curtain::GraspParams();
  grasp.id = id;
  if (goal.frame.size() > kLongestName) {
    log.add("frame", "must be no longer than " + std::to_string(kLongestName) + " bytes, is " + forLog(goal.frame, 20));
  }
  switch (goal.region) {
    case GraspGoal::SPHERE:
      grasp.region = curtain::GraspRegion::kSphere;
      break;
    case GraspGoal::BOX:
      grasp.region = curtain::GraspRegion::kBox;
      break;
    case GraspGoal::NODES:
      grasp.region = curtain::GraspRegion::kNodes;
      readNodes(goal, cloth, log, grasp);
      break;
    default:
      log.add("region", "must be SPHERE (0), BOX (1) or NODES (2), is " + std::to_string(goal.region));
  }
  grasp.place = {toVec3(goal.place.position), rotationOf(goal.place.orientation)};
  grasp.radius = goal.radius;
  grasp.size = toVec3(goal.size);
  grasp.stiffness = orNone(goal.stiffness);
  grasp.break_force = orNone(goal.break_force);
  grasp.pinch_force = orNone(goal.pinch_force);
  if (goal.friction != 0.0) grasp.friction = goal.friction;
  check.number("lifetime", goal.lifetime, curtain::notNegative());
  if (!log.problems().empty()) return log.problems();
  return curtain::validate(grasp, cloth, "");
}

}  // namespace curtain_ros
