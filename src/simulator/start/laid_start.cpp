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

Scene settlingScene(const Scene& scene, const ObstacleSet& obstacles, int number) {
  Scene settling;  // of the rest nothing
  settling.cloth = scene.cloth;
  settling.gravity = scene.gravity;
  settling.obstacles = scene.obstacles;
  settling.contact = scene.contact;
  settling.solver = scene.solver;
  for (int k = 0; k < obstacles.count(); ++k) {
    ObstacleParams& obstacle = settling.obstacles[static_cast<std::size_t>(k)];
    obstacle.pose = obstacles.reached(k);
    obstacle.motion.clear();
    obstacle.velocity = obstacle.acceleration = obstacle.spin = Vec3::Zero();
  }
  const Transform place(obstacles.reached(number));
  const Eigen::AlignedBox3d bounds = obstacles.shape(number).bounds();
  Vec3 middle = place.translation;  // of a plane, which has no bounds
  double top = middle.z();
  if (bounds.sizes().allFinite()) {
    middle = place.toWorld(bounds.center());
    top = middle.z() + place.rotation.row(2).cwiseAbs().dot(0.5 * bounds.sizes());
  }
  middle.z() = top + obstacles.padding(number) + 2.0 * scene.contact.thickness;
  Vec3 along = scene.hang.to - scene.hang.from;
  along.z() = 0.0;
  along = along.norm() > 0.0 ? Vec3(along.normalized()) : Vec3::UnitX();
  const Vec3 down = along.cross(Vec3::UnitZ());
  settling.hang.from = middle - 0.5 * scene.cloth.width * along - 0.5 * scene.cloth.height * down;
  settling.hang.to = settling.hang.from + scene.cloth.width * along;
  settling.hang.tilt = 0.5 * kPi;
  settling.pins.kind = PinKind::kNone;
  settling.air.inside = settling.air.border = settling.air.corner = kThickAir;
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
