// SPDX-License-Identifier: BSD-3-Clause
//
// Motions of whole scenes, written down frame by frame and compared node by node.
#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain_test {

/// Where every node was at every frame's end, row-major; the start first.
struct Motion {
  int rows = 0, columns = 0;
  std::vector<std::vector<curtain::Vec3>> positions;   ///< [m]
  std::vector<std::vector<curtain::Vec3>> velocities;  ///< [m/s]
  curtain::Statistics statistics;                      ///< at the end
};

/// Makes so many frames; `before` is called before each of them.
inline Motion record(const curtain::Scene& scene, int frames,
                     const std::function<void(curtain::Simulator&, int)>& before = nullptr) {
  curtain::Simulator simulator(scene);
  Motion motion;
  motion.rows = simulator.rows();
  motion.columns = simulator.columns();
  for (int frame = 0; frame <= frames; ++frame) {
    if (frame > 0) {
      if (before) before(simulator, frame);
      simulator.step();
    }
    motion.positions.emplace_back();
    motion.velocities.emplace_back();
    simulator.copyPositions(motion.positions.back());
    simulator.copyVelocities(motion.velocities.back());
  }
  motion.statistics = simulator.statistics();
  return motion;
}

/// The largest distance between a node of one motion and the same node of the other at any frame's end [m]; infinite
/// when one is not a number.
inline double farthestApart(const Motion& a, const Motion& b) {
  double worst = 0.0;
  for (std::size_t frame = 0; frame < a.positions.size(); ++frame) {
    for (std::size_t n = 0; n < a.positions[frame].size(); ++n) {
      const double apart = (a.positions[frame][n] - b.positions[frame][n]).norm();
      worst = apart <= worst ? worst : apart;
      if (!(apart < 1e300)) return 1e300;
    }
  }
  return worst;
}

/// The largest way that a node has gone from its start [m].
inline double farthestGone(const Motion& motion) {
  double worst = 0.0;
  for (const std::vector<curtain::Vec3>& at : motion.positions) {
    for (std::size_t n = 0; n < at.size(); ++n) worst = std::max(worst, (at[n] - motion.positions[0][n]).norm());
  }
  return worst;
}

/// The first frame in which two motions differ in any number; -1: in none, they are the same.
inline int firstDifference(const Motion& a, const Motion& b) {
  for (std::size_t frame = 0; frame < a.positions.size(); ++frame) {
    if (a.positions[frame] != b.positions[frame] || a.velocities[frame] != b.velocities[frame])
      return static_cast<int>(frame);
  }
  return -1;
}

}  // namespace curtain_test
