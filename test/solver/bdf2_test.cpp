// SPDX-License-Identifier: BSD-3-Clause
//
// Where a substep of bdf2 starts from, and what makes it begin anew.
#include "solver/schemes/bdf2.h"

#include <gtest/gtest.h>

#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

struct Scheme2 {
  Scheme2()
      : scene(flatScene(3, 4)),
        pattern(makePattern(scene)),
        state(makeInitialState(scene, pattern)),
        workers(1),
        inertia(pattern),
        bending(pattern, workers),
        scheme(pattern) {
    force.assign(pattern.grid.size(), 0.0);
    forces.force = &force;
  }
  /// The state moves on at these velocities for h, as a substep that is taken.
  void take(double h) {
    const ClothState before = state;
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) state.position.add(n, h * state.velocity.at(n));
    scheme.taken(before, h);
  }
  SubstepStart start(double h) {
    plan.h = h;
    SubstepOutcome outcome;
    const double step = scheme.stepFor(h);
    return scheme.start({plan, step, step, forces, inertia, bending}, state, outcome);
  }

  Scene scene;
  ClothPattern pattern;
  ClothState state;
  Field3 force;
  NodeForces forces;
  Workers workers;
  NodeInertia inertia;
  Bending bending;
  SubstepPlan plan;
  Bdf2 scheme;
};

TEST(Bdf2, TheFirstStepIsBackwardEuler) {
  Scheme2 bdf2;
  EXPECT_EQ(bdf2.scheme.stepFor(0.01), 0.01);
  EXPECT_EQ(&bdf2.start(0.01).state, &bdf2.state);
}

// y' = 4/3 y - 1/3 y_before + 2/3 h f.
TEST(Bdf2, EqualStepsStartFromTheLastTwo) {
  Scheme2 bdf2;
  const std::size_t node = bdf2.pattern.grid.index(2, 1);
  const Vec3 before = bdf2.state.position.at(node);
  bdf2.state.velocity.set(node, Vec3(1.0, 2.0, 3.0));
  bdf2.take(0.01);
  EXPECT_NEAR(bdf2.scheme.stepFor(0.01), 2.0 / 3.0 * 0.01, kEps * 0.01);
  const Vec3 now = bdf2.state.position.at(node);
  const Vec3 wanted = 4.0 / 3.0 * now - 1.0 / 3.0 * before;
  EXPECT_NEAR((bdf2.start(0.01).state.position.at(node) - wanted).norm(), 0.0, 8.0 * kEps);
}

// What is at rest stays there to the bit, with any ratio of steps.
TEST(Bdf2, RestIsKept) {
  Scheme2 bdf2;
  bdf2.take(0.01);
  const std::size_t node = bdf2.pattern.grid.index(1, 2);
  EXPECT_EQ(bdf2.start(0.0137).state.position.at(node), bdf2.state.position.at(node));
}

// Stable while steps grow by less than 1 + sqrt(2) at once (Grigorieff 1983).
TEST(Bdf2, AMuchLongerStepBeginsAnew) {
  Scheme2 bdf2;
  bdf2.take(0.01);
  EXPECT_LT(bdf2.scheme.stepFor(0.02), 0.02);
  EXPECT_EQ(bdf2.scheme.stepFor(0.025), 0.025);
}

TEST(Bdf2, ABlowIsMadeAgainFromOneStepAndForgottenInTwoMore) {
  Scheme2 bdf2;
  bdf2.take(0.01);
  EXPECT_TRUE(bdf2.scheme.struck());
  EXPECT_EQ(bdf2.scheme.stepFor(0.01), 0.01);
  EXPECT_FALSE(bdf2.scheme.struck());
  for (int k = 0; k < 2; ++k) {
    bdf2.take(0.01);
    EXPECT_EQ(bdf2.scheme.stepFor(0.01), 0.01) << k;
  }
  bdf2.take(0.01);
  EXPECT_LT(bdf2.scheme.stepFor(0.01), 0.01);
}

TEST(Bdf2, AStepOfAnotherSchemeIsNoStepBefore) {
  Scheme2 bdf2;
  bdf2.take(0.01);
  bdf2.scheme.passedOver();
  EXPECT_EQ(bdf2.scheme.stepFor(0.01), 0.01);
}

}  // namespace
}  // namespace curtain
