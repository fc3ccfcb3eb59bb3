// SPDX-License-Identifier: BSD-3-Clause
//
// Motions of whole scenes, written down frame by frame and compared node by node.
#pragma once

#include <functional>
#include <vector>

#include "curtain_sim/scene.h"
#include "curtain_sim/simulator.h"
#include "curtain_sim/statistics.h"

namespace curtain_test {

/// Where every node was at every frame's end, row-major; the start first.
struct Motion {
  int rows = 0, columns = 0;
  std::vector<std::vector<curtain::Vec3>> positions;   ///< [m]
  std::vector<std::vector<curtain::Vec3>> velocities;  ///< [m/s]
  curtain::Statistics statistics;                      ///< at the end
};

/// Makes so many frames; `before` is called before each of them.
Motion record(const curtain::Scene& scene, int frames,
              const std::function<void(curtain::Simulator&, int)>& before = nullptr);

/// The largest distance between a node of one motion and the same node of the other at any frame's end [m]; infinite
/// when one is not a number.
double farthestApart(const Motion& a, const Motion& b);

/// The largest way that a node has gone from its start [m].
double farthestGone(const Motion& motion);

/// The first frame in which two motions differ in any number; -1: in none, they are the same.
int firstDifference(const Motion& a, const Motion& b);

}  // namespace curtain_test
