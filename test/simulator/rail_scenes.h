// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes on a rail, and what holds of every one of them.
#pragma once

#include <gtest/gtest.h>

#include <vector>

#include "curtain_sim/simulator.h"
#include "scene/rail_layout.h"
#include "scene/rail_path.h"
#include "testing.h"

namespace curtain_test {

/// Cloth of width x 1 m on a straight level rail along +x, 2 m high; a carrier at every `every` columns.
inline curtain::Scene railScene(int rows, int columns, int every, double width, double rail_length) {
  curtain::Scene scene = flatScene(rows, columns, 1.0, width);
  scene.rail.path = {{{0.0, 0.0, 2.0}, {}}, {{rail_length, 0.0, 2.0}, {}}};
  scene.rail.carriers.every = every;
  return scene;
}

/// Two columns with a carrier each, a few centimetres apart, on a straight rail of 5 m that falls by `slope` (its
/// tangent) to the right. The cloth weighs so many kg in all, the carriers 0.1 kg each.
inline curtain::Scene slideScene(double cloth_mass, double slope, double friction) {
  curtain::Scene scene = railScene(3, 2, 1, 0.05, 5.0);
  scene.rail.path[1].to.z() = 2.0 - 5.0 * slope;
  scene.cloth.height = 0.2;
  scene.cloth.surface_density = cloth_mass / (scene.cloth.height * scene.cloth.width);
  scene.rail.carriers.mass = 0.1;
  scene.rail.carriers.friction = friction;
  scene.solver.rest_speed = 0.0;
  return scene;
}

inline double carrierX(const curtain::Simulator& simulator, int column) { return simulator.position({0, column}).x(); }

/// Carriers are on the rail, in order, with their gaps.
inline void expectOnRail(const curtain::Simulator& simulator) {
  const curtain::Scene& scene = simulator.scene();
  const curtain::RailPath path(scene.rail.path);
  constexpr double kRounding = 1e-12;
  double before = -scene.rail.carriers.gap;
  for (const int column : curtain::RailLayout::columnsOf(scene)) {
    const curtain::Vec3 point = simulator.position({0, column});
    const double place = path.nearest(point);
    ASSERT_LE((path.at(place).point - point).norm(), kRounding) << "column " << column;
    ASSERT_GE(place - before, scene.rail.carriers.gap - 10.0 * kRounding) << "column " << column;
    before = place;
  }
}

}  // namespace curtain_test
