// SPDX-License-Identifier: BSD-3-Clause
//
// What there is to see at one moment: a copy, so that a sensor may look at it while the simulation goes on.
#pragma once

#include <cstdint>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain {

struct Moment {
  FineMesh mesh;
  std::vector<Vec3> velocities;  ///< [m/s] of the first-layer nodes, row-major
  std::vector<Pose> obstacles;   ///< in the world, in the scene's order
  std::vector<char> present;     ///< obstacles that are there
  std::uint64_t frame = 0;       ///< of the simulation, which random numbers depend on
};

/// The present one. Allocates nothing once `out` was filled.
inline void readMoment(const Simulator& simulator, Moment& out) {
  simulator.copyFineMesh(out.mesh);
  simulator.copyVelocities(out.velocities);
  const auto count = static_cast<std::size_t>(simulator.obstacleCount());
  out.obstacles.resize(count);
  out.present.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    out.obstacles[i] = simulator.obstaclePose(static_cast<int>(i));
    out.present[i] = simulator.obstaclePresent(static_cast<int>(i)) ? 1 : 0;
  }
  out.frame = static_cast<std::uint64_t>(simulator.statistics().frames);
}

}  // namespace curtain
