// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that rubs within itself and resists twist: nothing is lost but what the friction is said to take, it comes to
// rest, and what it remembers is kept by snapshots and by frames that are made twice.
#include <gtest/gtest.h>

#include <cmath>

#include "curtain_sim/simulator.h"
#include "figures.h"
#include "testing.h"

namespace curtain {
namespace {

// A stiff sheet on its upper edge, let go 0.2 rad from the plumb, in no air.
Scene stiffScene() {
  Scene scene = curtain_test::flatScene(16, 17, 1.0, 1.0);
  scene.cloth.bending_warp = scene.cloth.bending_weft = 1e-3;
  scene.cloth.bending_bias = 2e-3;
  scene.cloth.bending_hysteresis = 3e-3;
  scene.cloth.shear = 30.0;
  scene.hang.tilt = 0.2;
  scene.air.inside = scene.air.border = scene.air.corner = 0.0;
  return scene;
}

double totalOf(const Simulator& simulator) {
  const Energy energy = simulator.energy();
  return energy.kinetic + energy.potential;
}

// Leapfrog's energy wavers by the square of the step: 32 substeps and the 7 that are chosen, by 20 times as much.
TEST(Hysteresis, LosesWhatItDissipates) {
  for (const int substeps : {32, 0}) {
    Scene scene = stiffScene();
    scene.solver.substeps = substeps;
    Simulator simulator(scene);
    simulator.countWork(true);
    const double start = totalOf(simulator);
    double most = 0.0, swings = 0.0;
    for (int frame = 0; frame < 120; ++frame) {
      simulator.step();
      most = std::max(most, std::abs(totalOf(simulator) + simulator.work().dissipated - start));
      swings = std::max(swings, simulator.energy().kinetic);
    }
    EXPECT_GT(simulator.work().dissipated, 0.01 * swings);
    curtain_test::keepFigure(std::string("hysteresis, energy wavers, ") + (substeps > 0 ? "32 substeps" : "auto"),
                             most / swings);
    EXPECT_LT(most, (substeps > 0 ? 1e-5 : 2e-4) * swings) << substeps;
  }
}

// It stops where its friction holds it, off the plumb, and sleeps there.
TEST(Hysteresis, HoldsClothOffItsPlumbPlace) {
  Scene scene = stiffScene();
  scene.cloth.bending_hysteresis = 0.2;
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  scene.pins.kind = PinKind::kList;  // clamped: two rows
  for (int j = 0; j < 17; ++j) scene.pins.nodes.insert(scene.pins.nodes.end(), {{0, j}, {1, j}});
  Simulator held(scene);
  scene.cloth.bending_hysteresis = 0.0;
  Simulator free(scene);
  for (int frame = 0; frame < 900; ++frame) {
    held.step();
    free.step();
  }
  EXPECT_TRUE(held.statistics().asleep);
  EXPECT_TRUE(free.statistics().asleep);
  EXPECT_GT((held.position({15, 8}) - free.position({15, 8})).norm(), 0.005);
}

TEST(Hysteresis, IsKeptBySnapshots) {
  Simulator simulator(stiffScene()), other(stiffScene());
  for (int frame = 0; frame < 20; ++frame) simulator.step();
  ASSERT_TRUE(other.restore(simulator.snapshot()).empty());
  for (int frame = 0; frame < 20; ++frame) {
    simulator.step();
    other.step();
  }
  EXPECT_EQ(simulator.stateHash(), other.stateHash());
  simulator.reset();
  Simulator fresh(stiffScene());
  for (int frame = 0; frame < 20; ++frame) {
    simulator.step();
    fresh.step();
  }
  EXPECT_EQ(simulator.stateHash(), fresh.stateHash());
}

// The reference run of the error estimate leaves nothing behind, and the books count frames once.
TEST(Hysteresis, IsForgottenByTrialRuns) {
  Scene scene = stiffScene();
  scene.solver.position_tolerance = 1e-3;
  Simulator simulator(scene);
  simulator.countWork(true);
  const double start = totalOf(simulator);
  double swings = 0.0;
  for (int frame = 0; frame < 60; ++frame) {
    simulator.step();
    swings = std::max(swings, simulator.energy().kinetic);
  }
  EXPECT_LT(std::abs(totalOf(simulator) + simulator.work().dissipated - start), 1e-3 * swings);
}

}  // namespace
}  // namespace curtain
