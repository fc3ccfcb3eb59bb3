// SPDX-License-Identifier: BSD-3-Clause
//
// How much a motion amplifies what is a little off, so that tolerances can be derived: a motion in which every number
// of the scene is off by a share tells what becomes of rounding, or of what the solver leaves over.
#pragma once

#include "cloth/cloth.h"
#include "properties/motion.h"
#include "testing.h"

namespace curtain_test {

/// The scene with its numbers off by up to this share: lengths, masses, forces, and of what has a direction that too.
inline curtain::Scene disturbed(curtain::Scene scene, double share, std::uint64_t seed) {
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

/// How far a share moves the nodes [m]: the largest distance to any of `tries` motions that are off by `share`, over
/// it.
inline double growthOf(const curtain::Scene& scene, const Motion& motion, double share, std::uint64_t seed,
                       int tries = 2) {
  const int frames = static_cast<int>(motion.positions.size()) - 1;
  double worst = 0.0;
  for (int n = 0; n < tries; ++n) {
    const auto of_try = seed * 16 + static_cast<std::uint64_t>(n);
    worst = std::max(worst, farthestApart(motion, record(disturbed(scene, share, of_try), frames)));
  }
  return worst / share;
}

/// The longest that a weft link is in a motion, over its length: below 1, no string has pulled.
inline double longestString(const curtain::Scene& scene, const Motion& motion) {
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

/// A string may have pulled, in a frame as well: that is how fast its ends part at a frame's end, for as long as a frame.
inline bool stringsMayPull(const curtain::Scene& scene, const Motion& motion) {
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

/// Share of a force that single precision may take: 2^-24 of each correction, and about as much for each of the iterations
/// whose errors the next ones do not see, eight at most.
constexpr double kSingle = 8.0 * 0x1p-24;

/// The share of gravity that rounding amounts to, if all of it went one way: positions of this size [m] are rounded by
/// 2^-53 of it once a substep of h seconds, which is an acceleration of 2^-53 size / h^2. h: the shortest substep of a
/// motion of so many frames, taken for half of their mean, over `stages`.
inline double roundingShare(const curtain::Scene& scene, const Motion& motion, double size) {
  const double frames = static_cast<double>(motion.statistics.frames);
  const double stages = scene.solver.method == curtain::Method::kLeapfrog4 ? 5.0 : 1.0;
  const double steps = static_cast<double>(motion.statistics.substeps) / frames * stages;
  const double h = 0.5 / (scene.solver.frame_rate * steps);
  return 0.5 * kEps * size / (h * h * scene.gravity.norm());
}

}  // namespace curtain_test
