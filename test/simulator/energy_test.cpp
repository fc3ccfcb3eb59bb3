// SPDX-License-Identifier: BSD-3-Clause
//
// The total energy of an undamped swing over a minute has no trend.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

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

}  // namespace
}  // namespace curtain
