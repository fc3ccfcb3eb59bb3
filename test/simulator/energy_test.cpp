// SPDX-License-Identifier: BSD-3-Clause
//
// The total energy of undamped cloth: of a swing over a minute it has no trend, and whips whose tension makes substeps
// change do not collect any. And it is the same whoever asks for it, whenever.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "figures.h"
#include "simulator/chains.h"

namespace curtain {
namespace {

struct Trend {
  double slope = 0.0;  // of the least squares line over a minute, in m g L
  double means = 0.0;  // mean of the last five seconds less that of the first
  double waver = 0.0;  // the farthest any frame was off the start
};

Trend trendOfAMinute(Method method) {
  constexpr int kFrames = 3600;
  constexpr int kMean = 300;
  Scene scene = curtain_test::chainScene(43);
  scene.solver.method = method;
  scene.solver.substeps = 8;
  Simulator simulator(scene);
  const double scale = scene.cloth.surface_density * scene.cloth.width * scene.cloth.height *  // m
                       scene.gravity.norm() * scene.cloth.height;
  const double start = simulator.energy().potential;
  Trend trend;
  double moment = 0.0, spread = 0.0;
  for (int frame = 0; frame < kFrames; ++frame) {
    simulator.step();
    const Energy energy = simulator.energy();
    const double off = (energy.kinetic + energy.potential - start) / scale;
    const double time = (frame + 0.5) / kFrames - 0.5;  // minutes, from the middle
    moment += time * off;
    spread += time * time;
    if (frame < kMean) trend.means -= off / kMean;
    if (frame >= kFrames - kMean) trend.means += off / kMean;
    trend.waver = std::max(trend.waver, std::abs(off));
  }
  trend.slope = moment / spread;
  std::printf("%s: slope %.2e a minute, means %.2e, waver %.2e of m g L\n", toString(method).c_str(), trend.slope,
              trend.means, trend.waver);
  return trend;
}

// What a symplectic scheme keeps is not the energy but one that differs from it by order h^2: the energy's value wavers
// with the motion, at 8 substeps by (h omega)^2 / 8 = 2e-4 (modes of 20 / s) of the 0.15 m g L that swing, 3e-5 m g L,
// without a trend. Bound: a third of what it wavers.
TEST(SwingEnergy, OfLeapfrogHasNoTrend) {
  const Trend trend = trendOfAMinute(Method::kLeapfrog);
  EXPECT_LT(std::abs(trend.slope), 1e-5);
  EXPECT_LT(std::abs(trend.means), 1e-5);
  EXPECT_LT(trend.waver, 3e-5);
}

// Leapfrog4 wavers with h^4, and at 8 substeps is a thousand times as exact as leapfrog: a tenth of leapfrog's bounds
// is lax.
TEST(SwingEnergy, OfLeapfrog4HasNoTrend) {
  const Trend trend = trendOfAMinute(Method::kLeapfrog4);
  EXPECT_LT(std::abs(trend.slope), 1e-6);
  EXPECT_LT(std::abs(trend.means), 1e-6);
  EXPECT_LT(trend.waver, 3e-6);
}

// Let go at 70 degrees it whips, with as many substeps as its tensions ask for: two to ten a frame.
class WhipEnergy : public ::testing::TestWithParam<std::tuple<Method, int>> {};

// Never above the start by more than what is let be (kTooMuch in keep_energy.cpp), at the end of a frame; and not at
// the cost of the motion: a scheme that damps loses a quarter of m g H in half of this time, this may be a fifth of
// that.
TEST_P(WhipEnergy, IsNotCollected) {
  const auto& [method, substeps] = GetParam();
  Scene scene = curtain_test::flatScene(12, 10);
  scene.hang.tilt = 1.2;
  scene.hang.to.x() = 0.9;
  scene.solver.method = method;
  scene.solver.substeps = substeps;
  Simulator simulator(scene);
  double weight = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) weight += simulator.mass({i, j}) * scene.gravity.norm();
  }
  const double scale = weight * scene.cloth.height, start = simulator.energy().potential;
  double lowest = 0.0, highest = 0.0;
  for (int frame = 0; frame < 3600; ++frame) {
    simulator.step();
    const Energy energy = simulator.energy();
    const double off = (energy.kinetic + energy.potential - start) / scale;
    lowest = std::min(lowest, off);
    highest = std::max(highest, off);
  }
  curtain_test::keepFigure("a whip's energy, most above the start", highest);
  curtain_test::keepFigure("a whip's energy, most below the start", lowest);
  EXPECT_LE(highest, 1.01e-2);
  EXPECT_GE(lowest, -0.05);
}

INSTANTIATE_TEST_SUITE_P(Methods, WhipEnergy,
                         ::testing::Values(std::tuple(Method::kAuto, 0), std::tuple(Method::kLeapfrog, 0),
                                           std::tuple(Method::kLeapfrog4, 0), std::tuple(Method::kLeapfrog, 8)),
                         [](const auto& named) {
                           return toString(std::get<0>(named.param)) + (std::get<1>(named.param) > 0 ? "Fixed" : "");
                         });

// Gravity that changes between two frames: velocities are still those that the old one made, whether they were asked
// for or not.
TEST(Energy, IsOfTheForcesThatWere) {
  const Scene scene = curtain_test::chainScene(20);
  Simulator asked(scene), unasked(scene);
  for (Simulator* simulator : {&asked, &unasked}) {
    for (int frame = 0; frame < 5; ++frame) simulator->step();
  }
  const Energy before = asked.energy();
  for (Simulator* simulator : {&asked, &unasked}) EXPECT_TRUE(simulator->setGravity({20.0, -10.0, 5.0}).empty());
  EXPECT_EQ(asked.energy().kinetic, before.kinetic);
  EXPECT_EQ(unasked.energy().kinetic, before.kinetic);
}

}  // namespace
}  // namespace curtain
