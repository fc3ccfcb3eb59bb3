// SPDX-License-Identifier: BSD-3-Clause
//
// Strips of cloth clamped at one end, as bending is measured on.
#pragma once

#include <algorithm>
#include <cmath>

#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain_test {

/// A strip of two lines of `rods` links that stands out horizontally; one more link is held fast.
struct Strip {
  int rods = 40;
  double length = 1.0;     // [m]
  double density = 0.2;    // [kg/m^2]
  double rigidity = 0.02;  // [N m]
  bool along_warp = true;  // else the weft's threads bend
};

inline curtain::NodeIndex nodeOf(const Strip& strip, int row) {
  return strip.along_warp ? curtain::NodeIndex{row, 0} : curtain::NodeIndex{0, row};
}

/// Lowest frequency of the strip without weight [rad/s]: beta^2 sqrt(B / density) / L^2, beta = 1.8751.
inline double lowestFrequency(const Strip& strip) {
  return 3.5160152685 * std::sqrt(strip.rigidity / strip.density) / (strip.length * strip.length);
}

inline curtain::Scene stripScene(const Strip& strip) {
  const double rod = strip.length / strip.rods, whole = strip.length + rod, across = 0.1 * strip.length;
  const int nodes = strip.rods + 2;
  curtain::Scene scene = strip.along_warp ? flatScene(nodes, 2, whole, across) : flatScene(2, nodes, across, whole);
  scene.cloth.surface_density = strip.density;
  (strip.along_warp ? scene.cloth.bending_warp : scene.cloth.bending_weft) = strip.rigidity;
  scene.hang.tilt = 0.5 * kPi;
  scene.pins.kind = curtain::PinKind::kList;
  scene.pins.nodes = {{0, 0}, {0, 1}, {1, 0}, {1, 1}};
  scene.solver.rest_speed = 0.0;
  return scene;
}

/// Where the free end hangs, seen from the clamp [m].
struct Overhang {
  double drop = 0.0, reach = 0.0;
};

/// Lets the strip sink to rest in air that damps its lowest mode critically.
inline Overhang sinkToRest(const Strip& strip, curtain::Scene scene) {
  const double rate = 2.0 * lowestFrequency(strip);
  scene.air.inside = scene.air.border = scene.air.corner = rate * strip.density / scene.air.density;
  scene.air.threshold = 1e6;  // linear throughout
  curtain::Simulator simulator(scene);
  const auto overhang = [&] {
    const curtain::Vec3 way = simulator.position(nodeOf(strip, strip.rods + 1)) - simulator.position(nodeOf(strip, 1));
    return Overhang{-way.z(), std::hypot(way.x(), way.y())};
  };
  // A tenth of a period without motion: what is left is below the share of it that decays in that time.
  const int look = std::max(1, static_cast<int>(0.1 * 2.0 * kPi / lowestFrequency(strip) * scene.solver.frame_rate));
  Overhang last = overhang();
  for (int frame = 1; frame < 200 * look; ++frame) {
    simulator.step();
    if (frame % look != 0) continue;
    const Overhang now = overhang();
    if (frame > 5 * look && std::abs(now.drop - last.drop) + std::abs(now.reach - last.reach) < 1e-6 * strip.length)
      return now;
    last = now;
  }
  ADD_FAILURE() << "does not come to rest";
  return last;
}

}  // namespace curtain_test
