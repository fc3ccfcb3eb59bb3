// SPDX-License-Identifier: BSD-3-Clause
#include "properties/growth.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cloth/cloth.h"
#include "testing.h"

namespace curtain_test {

curtain::Scene disturbed(curtain::Scene scene, double share, std::uint64_t seed) {
  Random random(seed + 1000);
  const auto scale = [&](double& value) { value *= 1.0 + share * random.between(-1.0, 1.0); };
  const auto turn = [&](curtain::Vec3& value) { value += share * value.norm() * random.inBox(1.0); };
  const auto shift = [&](curtain::Vec3& value) { value += share * scene.cloth.height * random.inBox(1.0); };
  const auto scaleAll = [&](std::vector<double>& values, int count) {
    if (values.empty()) values.assign(static_cast<std::size_t>(count), 1.0);
    for (double& value : values) scale(value);
  };
  scaleAll(scene.cloth.row_spacing, scene.cloth.rows - 1);
  scaleAll(scene.cloth.column_spacing, curtain::weftLinkCount(scene.cloth));
  scaleAll(scene.cloth.row_mass, scene.cloth.rows);
  scaleAll(scene.cloth.column_mass, scene.cloth.columns);
  turn(scene.gravity);
  scene.hang.tilt += share * random.between(-1.0, 1.0);
  scene.hang.to -= share * std::abs(random.between(-1.0, 1.0)) * (scene.hang.to - scene.hang.from);
  for (auto& wind : scene.wind) {
    scale(wind.pressure);
    turn(wind.direction);
  }
  for (auto& drag : scene.drag) {
    turn(drag.force);
    if (drag.target) shift(*drag.target);
  }
  for (auto& obstacle : scene.obstacles) {
    curtain::Vec3 way = curtain::Vec3::Zero();
    shift(way);
    obstacle.pose.position += way;
    for (auto& key : obstacle.motion) key.pose.position += way;
  }
  return scene;
}

double growthOf(const curtain::Scene& scene, const Motion& motion, double share, std::uint64_t seed, int tries) {
  const int frames = static_cast<int>(motion.positions.size()) - 1;
  double worst = 0.0;
  for (int n = 0; n < tries; ++n) {
    const auto of_try = seed * 16 + static_cast<std::uint64_t>(n);
    worst = std::max(worst, farthestApart(motion, record(disturbed(scene, share, of_try), frames)));
  }
  return worst / share;
}

double longestString(const curtain::Scene& scene, const Motion& motion) {
  const curtain::ClothPattern pattern = makePattern(scene);
  double longest = 0.0;
  for (const std::vector<curtain::Vec3>& at : motion.positions) {
    for (int i = 0; i < motion.rows; ++i) {
      for (int j = 1; j < motion.columns; ++j) {
        const auto n = static_cast<std::size_t>(i * motion.columns + j);
        longest = std::max(longest, (at[n] - at[n - 1]).norm() / pattern.weft_rest[pattern.grid.index(i, j)]);
      }
    }
  }
  return longest;
}

bool stringsMayPull(const curtain::Scene& scene, const Motion& motion) {
  const curtain::ClothPattern pattern = makePattern(scene);
  const double frame = 1.0 / scene.solver.frame_rate;
  for (std::size_t k = 0; k < motion.positions.size(); ++k) {
    for (int i = 0; i < motion.rows; ++i) {
      for (int j = 1; j < motion.columns; ++j) {
        const auto n = static_cast<std::size_t>(i * motion.columns + j);
        const double length = (motion.positions[k][n] - motion.positions[k][n - 1]).norm();
        const double parting = (motion.velocities[k][n] - motion.velocities[k][n - 1]).norm();
        if (length + frame * parting >= pattern.weft_rest[pattern.grid.index(i, j)]) return true;
      }
    }
  }
  return false;
}

double roundingShare(const curtain::Scene& scene, const Motion& motion, double size) {
  const double frames = static_cast<double>(motion.statistics.frames);
  const double stages = scene.solver.method == curtain::Method::kLeapfrog4 ? 5.0 : 1.0;
  const double steps = static_cast<double>(motion.statistics.substeps) / frames * stages;
  const double h = 0.5 / (scene.solver.frame_rate * steps);
  return 0.5 * kEps * size / (h * h * scene.gravity.norm());
}

}  // namespace curtain_test
