// SPDX-License-Identifier: BSD-3-Clause
//
// Straps over a bar without friction: scarves that slide off, Atwood's machine, and loads that a pin holds. Each has a
// closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "figures.h"
#include "over_a_bar.h"
#include "simulator/scenes.h"

namespace curtain {
namespace {

using curtain_test::energyOf;
using curtain_test::layOver;
using curtain_test::massOfRow;
using curtain_test::Strap;
using curtain_test::strapScene;

// Links of 15 mm around the bar are chords: the strap is further from the axis by (link / radius)^2 / 24 of it at most,
// 0.1 %, and its ends by half a link's turn at most, so times are right to 1 %; a way that grows as cosh(w t) with
// w t ~ 2 is so to 2 %.
constexpr double kChords = 0.02;

// x'' = 2 g x / L: half of what hangs further down on one side grows as cosh.
TEST(Scarf, SlidesOffAsItsWeightAsks) {
  for (const double rate : {30.0, 60.0, 240.0}) {
    Strap scarf;
    scarf.left = 0.35;
    scarf.right = 0.25;
    Scene scene = strapScene(scarf);
    scene.solver.frame_rate = rate;
    Simulator simulator(scene);
    const double half = 0.5 * (scarf.left - layOver(simulator, scarf)), before = simulator.position({0, 0}).z();
    const double energy = energyOf(simulator);
    double most = energy;
    while (simulator.time() < 0.5 - 1e-9) {
      simulator.step();
      most = std::max(most, energyOf(simulator));
    }
    const double grows = std::sqrt(2.0 * scene.gravity.norm() / scarf.length());
    const double expected = half * (std::cosh(grows * simulator.time()) - 1.0);
    const double slid = before - simulator.position({0, 0}).z();
    std::printf("%3.0f Hz: %.4f of the closed form, energy %+.1e of the motion's\n", rate, slid / expected,
                (energyOf(simulator) - energy) / simulator.energy().kinetic);
    curtain_test::keepFigure("scarf, of the closed form", slid / expected);
    curtain_test::keepFigure("scarf, energy over the motion's",
                             (energyOf(simulator) - energy) / simulator.energy().kinetic);
    EXPECT_NEAR(slid, expected, kChords * expected) << rate;
    EXPECT_LE(most - energy, 1e-3 * simulator.energy().kinetic) << rate;
  }
}

// x'' = g (M1 - M2 + 2 q x) / (M1 + M2 + m), q being the strap's mass over its length and m all of it:
// x = ((M1 - M2) / (2 q) + x0) (cosh(w t) - 1), x0 by how much further the first load hangs at the start, halved.
TEST(Atwood, SinksAsItsLoadsAsk) {
  for (const auto& [first, last] : {std::pair{0.055, 0.05}, {0.075, 0.05}, {0.008, 0.004}}) {
    Strap strap;
    strap.first_load = first;
    strap.last_load = last;
    Simulator simulator(strapScene(strap));
    const double half = 0.5 * (strap.left - layOver(simulator, strap));
    double all = 0.0;
    for (int row = 0; row < strap.rows; ++row) all += massOfRow(simulator, row);
    const double more = massOfRow(simulator, 0) - massOfRow(simulator, strap.rows - 1);
    const double before = simulator.position({0, 0}).z();
    for (int frame = 0; frame < 24; ++frame) simulator.step();
    const double grows = std::sqrt(2.0 * Strap::kPerLength * simulator.scene().gravity.norm() / all);
    const double expected = (more / (2.0 * Strap::kPerLength) + half) * (std::cosh(grows * simulator.time()) - 1.0);
    const double sank = before - simulator.position({0, 0}).z();
    std::printf("%g and %g kg: %.4f of the closed form\n", first, last, sank / expected);
    curtain_test::keepFigure("Atwood, of the closed form", sank / expected);
    EXPECT_NEAR(sank, expected, kChords * expected);
    EXPECT_EQ(simulator.statistics().last_resort_substeps, 0);
  }
}

// A load of 1 to 700 times the strap, the other end pinned. At rest the pull is the same at the same height, so the bar
// bears the load twice, and the strap.
TEST(Strap, CarriesWhatHangsOnIt) {
  struct Case {
    double load;
    int rows;
    double rate;  // [1/s]
  };
  // Of the last, sweeps along the substep's first directions pushed ever harder: it ended in the last resort.
  for (const auto& [load, rows, rate] :
       {Case{0.01, 61, 60.0}, {0.05, 61, 60.0}, {0.2, 61, 60.0}, {1.0, 61, 60.0}, {5.0, 61, 60.0}, {1.36, 98, 120.0}}) {
    Strap strap;
    strap.pinned = true;
    strap.last_load = load;
    strap.rows = rows;
    Scene scene = strapScene(strap);
    scene.solver.frame_rate = rate;
    scene.air.inside = scene.air.border = scene.air.corner = 1.0;
    Simulator simulator(scene);
    const double lower = layOver(simulator, strap) - strap.left;
    double all = 0.0;
    for (int row = 0; row < strap.rows; ++row) all += massOfRow(simulator, row);
    const double loads = massOfRow(simulator, strap.rows - 1);
    const double pull = loads + Strap::kPerLength * lower;  // at the pin's height [kg]
    for (int frame = 0; frame < 120; ++frame) simulator.step();
    const std::int64_t before = simulator.statistics().last_resort_substeps;
    double sum = 0.0;
    for (int frame = 0; frame < 60; ++frame) {
      simulator.step();
      sum -= simulator.contactWrench(0).force.z() / 60.0;
    }
    // The pinned row bears half a link itself.
    const double expected = simulator.scene().gravity.norm() * (all - massOfRow(simulator, 0) + pull);
    std::printf("%g kg: the bar bears %.4f of what it must\n", load, sum / expected);
    curtain_test::keepFigure("force on the bar, of the exact one", sum / expected);
    EXPECT_NEAR(sum, expected, 0.02 * expected) << load;
    EXPECT_EQ(simulator.statistics().last_resort_substeps, before) << load;
  }
}

}  // namespace
}  // namespace curtain
