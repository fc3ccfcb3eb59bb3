// SPDX-License-Identifier: BSD-3-Clause
#include "properties/motion.h"

#include <algorithm>

namespace curtain_test {

Motion record(const curtain::Scene& scene, int frames, const std::function<void(curtain::Simulator&, int)>& before) {
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

double farthestApart(const Motion& a, const Motion& b) {
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

double farthestGone(const Motion& motion) {
  double worst = 0.0;
  for (const std::vector<curtain::Vec3>& at : motion.positions) {
    for (std::size_t n = 0; n < at.size(); ++n) worst = std::max(worst, (at[n] - motion.positions[0][n]).norm());
  }
  return worst;
}

int firstDifference(const Motion& a, const Motion& b) {
  for (std::size_t frame = 0; frame < a.positions.size(); ++frame) {
    if (a.positions[frame] != b.positions[frame] || a.velocities[frame] != b.velocities[frame])
      return static_cast<int>(frame);
  }
  return -1;
}

}  // namespace curtain_test
