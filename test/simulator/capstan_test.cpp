// SPDX-License-Identifier: BSD-3-Clause
//
// A strap over a bar with friction, a load at either end: it holds as long as the one is less than e^(friction pi) of
// the other, and slides with what is more (Euler 1769, Eytelwein 1808).
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <sstream>

#include "over_a_bar.h"

namespace curtain {
namespace {

using curtain_test::bearable;
using curtain_test::layOver;
using curtain_test::Strap;
using curtain_test::strapScene;

constexpr double kLight = 0.05;  // [kg]

// By how much the heavy end sinks in a second [m]. load: over the largest that the strap holds; might: if that slides,
// by how much with the acceleration that is left.
double sunk(Method method, double friction, double load, double rate, double& might) {
  Strap strap;
  strap.rows = 124;  // links of 7.5 mm: a chain of chords holds 0.3 % more than a belt at a friction of 1
  strap.last_load = kLight;
  const double limit =
      bearable(strap, friction, kLight + Strap::kPerLength * strap.right) - Strap::kPerLength * strap.left;
  strap.first_load = load * limit;
  Scene scene = strapScene(strap);
  scene.obstacles[0].friction = friction;
  scene.solver.frame_rate = rate;
  scene.solver.method = method;
  Simulator simulator(scene);
  layOver(simulator, strap);
  const double before = simulator.position({0, 0}).z();
  for (int frame = 0; frame < static_cast<int>(std::lround(rate)); ++frame) simulator.step();
  might = 0.5 * scene.gravity.norm() * (load - 1.0) / (load + 1.0);
  return before - simulator.position({0, 0}).z();
}

struct Trial {
  Method method;
  double friction, rate;  // rate: frames [1/s]
  double off;             // the loads that are tried, from the limit
};

// The way is in proportion to what is too much: 0.05 off would sink as far as is let pass, and a limit that is too high
// by 0.75 off leaves a quarter. implicit starts each substep without the last one's pushes, and creeps.
TEST(Capstan, HoldsWhatEulersLawSays) {
  for (const Trial& one : {Trial{Method::kAuto, 0.1, 60.0, 0.03}, Trial{Method::kAuto, 0.3, 60.0, 0.03},
                           Trial{Method::kAuto, 0.5, 60.0, 0.03}, Trial{Method::kAuto, 0.8, 60.0, 0.03},
                           Trial{Method::kAuto, 1.0, 60.0, 0.03}, Trial{Method::kAuto, 0.3, 240.0, 0.03},
                           Trial{Method::kAuto, 0.8, 240.0, 0.03}, Trial{Method::kImplicit, 0.1, 60.0, 0.1},
                           Trial{Method::kImplicit, 0.3, 60.0, 0.1}}) {
    double might = 0.0;
    const double held = sunk(one.method, one.friction, 1.0 - one.off, one.rate, might),
                 slid = sunk(one.method, one.friction, 1.0 + one.off, one.rate, might);
    std::ostringstream what;
    what << toString(one.method) << ", friction " << one.friction << ", " << one.rate << " Hz";
    std::printf("%s: %g %% less than it holds sinks by %.2f mm, as much more by %.1f of %.1f mm\n", what.str().c_str(),
                1e2 * one.off, 1e3 * held, 1e3 * slid, 1e3 * might);
    EXPECT_LT(held, 0.05 * might) << what.str();
    EXPECT_GT(slid, 0.25 * might) << what.str();
  }
}

}  // namespace
}  // namespace curtain
