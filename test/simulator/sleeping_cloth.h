// SPDX-License-Identifier: BSD-3-Clause
//
// A curtain that comes to rest, what may disturb it, and how far two of them are apart.
#pragma once

#include <algorithm>
#include <vector>

#include "curtain_sim/simulator.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain_test {

using curtain::DragParams;
using curtain::NodeIndex;
using curtain::ObstacleParams;
using curtain::Scene;
using curtain::Simulator;
using curtain::Vec3;
using curtain::WindParams;

// A curtain of 1 m x 1 m, gathered a little, in air that damps what swings within a second. Short substeps: a force
// given from outside acts from half a substep before on what moves (docs/method.md), not on what sleeps.
inline Scene hanging() {
  Scene scene = flatScene(16, 20);
  scene.hang.from = {0.0, 0.0, 1.2};
  scene.hang.to = {0.9, 0.0, 1.2};
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  scene.solver.substeps = 32;
  return scene;
}

inline Scene sleepless(Scene scene) {
  scene.solver.rest_speed = 0.0;
  return scene;
}

inline bool sleepsWithin(Simulator& simulator, int frames) {
  for (int frame = 0; frame < frames; ++frame) {
    simulator.step();
    if (simulator.statistics().asleep) return true;
  }
  return false;
}

inline double farthestApart(const Simulator& a, const Simulator& b) {
  std::vector<Vec3> p, q;
  a.copyPositions(p);
  b.copyPositions(q);
  double worst = 0.0;
  for (std::size_t n = 0; n < p.size(); ++n) worst = std::max(worst, (p[n] - q[n]).norm());
  return worst;
}

inline double farthestMoved(const Simulator& simulator, const std::vector<Vec3>& from) {
  std::vector<Vec3> now;
  simulator.copyPositions(now);
  double worst = 0.0;
  for (std::size_t n = 0; n < now.size(); ++n) worst = std::max(worst, (now[n] - from[n]).norm());
  return worst;
}

inline ObstacleParams smallBallAt(const Vec3& position) { return ballAt(position, 0.15); }

inline WindParams fan(double pressure) {
  WindParams wind = fanAt({0.5, -1.0, 0.7}, 1.0);
  wind.pressure = pressure;
  return wind;
}

inline DragParams pull(const Vec3& force) {
  DragParams drag;
  drag.id = "hand";
  drag.node = NodeIndex{15, 10};
  drag.force = force;
  return drag;
}

}  // namespace curtain_test
