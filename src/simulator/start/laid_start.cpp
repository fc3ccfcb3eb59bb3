// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/start/laid_start.h"

#include <algorithm>
#include <cmath>

#include "scene/pi.h"

namespace curtain {
namespace {

// It falls on the obstacle in air that lets nothing swing for long [m/s], and is where it is after so long [s].
constexpr double kThickAir = 1.0, kLongest = 10.0;

}  // namespace

Scene settlingScene(const Scene& scene, const Eigen::AlignedBox3d& box) {
  Scene settling;  // of the rest nothing
  settling.cloth = scene.cloth;
  settling.gravity = scene.gravity;
  settling.obstacles = scene.obstacles;
  settling.contact = scene.contact;
  settling.solver = scene.solver;
  Vec3 along = scene.hang.to - scene.hang.from;
  along.z() = 0.0;
  along = along.norm() > 0.0 ? Vec3(along.normalized()) : Vec3::UnitX();
  const Vec3 down = along.cross(Vec3::UnitZ());
  Vec3 middle = box.center();
  double top = box.max().z();
  for (const ObstacleParams& obstacle : scene.obstacles) {
    if (obstacle.name == *scene.hang.start.over && !std::isfinite(top + middle.x() + middle.y())) {
      middle = obstacle.pose.position;  // a plane
      top = middle.z();
    }
    if (obstacle.name == *scene.hang.start.over) top += obstacle.padding;
  }
  middle.z() = top + 2.0 * scene.contact.thickness;
  settling.hang.from = middle - 0.5 * scene.cloth.width * along - 0.5 * scene.cloth.height * down;
  settling.hang.to = settling.hang.from + scene.cloth.width * along;
  settling.hang.tilt = 0.5 * kPi;
  settling.pins.kind = PinKind::kNone;
  settling.air.inside = settling.air.border = settling.air.corner = kThickAir;
  for (ObstacleParams& obstacle : settling.obstacles) {
    if (!obstacle.motion.empty()) obstacle.pose = obstacle.motion.front().pose;
    obstacle.motion.clear();
    obstacle.velocity = obstacle.acceleration = obstacle.spin = Vec3::Zero();
  }
  settling.solver.frame_rate = std::max(60.0, scene.solver.frame_rate);
  settling.solver.budget_ms = 0.0;
  settling.solver.position_tolerance = 0.0;
  return settling;
}

std::vector<Vec3> layOver(Simulator& resting) {
  while (!resting.statistics().asleep && resting.time() < kLongest) resting.step();
  std::vector<Vec3> positions;
  resting.copyPositions(positions);
  return positions;
}

}  // namespace curtain
