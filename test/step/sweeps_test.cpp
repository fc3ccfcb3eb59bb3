// SPDX-License-Identifier: BSD-3-Clause
//
// How a solve of links ends: converged, stalled, out of time or diverged; and what decides on the way.
#include "step/sweeps.h"

#include <gtest/gtest.h>

#include <chrono>
#include <limits>

#include "testing.h"

namespace curtain {
namespace {

using namespace curtain_test;

constexpr double kTolerance = 1e-3;

// A cloth whose nodes were predicted to be at constraints.next.
struct Solve {
  explicit Solve(const Scene& scene, int max_sweeps = 200)
      : pattern(makePattern(scene)),
        state(makeInitialState(scene, pattern)),
        workers(1),
        inertia(pattern),
        constraints(pattern, {}, 0.5 * kTolerance, inertia, workers),
        sweeps(constraints, inertia, kTolerance, kTolerance * shortestLink(pattern), max_sweeps) {
    force.assign(pattern.grid.size(), 0.0);
    forces.force = &force;
    inertia.set(forces, kStep, kStep * kStep, 0.0, false);
    constraints.begin({state, force, nullptr, nullptr, kStep, kStep}, state, 0.0, true, 9.81);
  }
  SweepOutcome run(bool last_resort = false) {
    const SweepTask task{state.position, last_resort, last_resort, false, 0.0, 0.0};
    return sweeps.run(task, clock);
  }
  double stretch() const {
    const Stretch warp = warpStretch(pattern, constraints.next);
    return std::max({warp.longer, warp.shorter, weftStretch(pattern, constraints.next)});
  }

  static constexpr double kStep = 1e-3;
  ClothPattern pattern;
  ClothState state;
  Field3 force;
  NodeForces forces;
  Workers workers;
  NodeInertia inertia;
  Constraints constraints;
  Sweeps sweeps;
  StageClock clock;
};

Scene cloth(PinKind pins) {
  Scene scene = flatScene(8, 7);
  scene.pins.kind = pins;
  return scene;
}

TEST(Sweeps, ClothThatFallsFreelyIsDoneInOne) {
  Solve solve(cloth(PinKind::kNone));
  for (std::size_t n = 0; n < solve.pattern.grid.size(); ++n) solve.constraints.next.add(n, Vec3(0.0, 0.0, -0.01));
  const SweepOutcome outcome = solve.run();
  EXPECT_EQ(outcome.end, SweepEnd::kConverged);
  EXPECT_TRUE(outcome.within);
  EXPECT_EQ(outcome.sweeps, 1);
}

TEST(Sweeps, ConvergedLinksAreWithinTheTolerance) {
  for (const PinKind pins : {PinKind::kTop, PinKind::kLeft, PinKind::kTopCorners, PinKind::kNone}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      Solve solve(cloth(pins));
      shake(solve.pattern, 0.02, seed, solve.constraints.next);
      const SweepOutcome outcome = solve.run();
      EXPECT_EQ(outcome.end, SweepEnd::kConverged) << seed;
      EXPECT_TRUE(outcome.within);
      EXPECT_LE(solve.stretch(), kTolerance) << seed;
    }
  }
}

TEST(Sweeps, PinsThatWerePulledApartStallTheSolve) {
  Scene scene = cloth(PinKind::kTopCorners);
  Solve solve(scene);
  solve.constraints.next.add(solve.pattern.grid.index(0, 6), Vec3(0.05, 0.0, 0.0));
  const SweepOutcome outcome = solve.run();
  EXPECT_EQ(outcome.end, SweepEnd::kStalled);
  EXPECT_FALSE(outcome.within);
  EXPECT_GT(outcome.sweeps, 1);
}

TEST(Sweeps, TooFewSweepsCountAsStalled) {
  Solve solve(cloth(PinKind::kTopCorners), 1);
  shake(solve.pattern, 0.05, 3, solve.constraints.next);
  const SweepOutcome outcome = solve.run();
  EXPECT_EQ(outcome.end, SweepEnd::kStalled);
  EXPECT_EQ(outcome.sweeps, 1);
}

TEST(Sweeps, ADeadlineEndsTheSolve) {
  Solve solve(cloth(PinKind::kTopCorners));
  shake(solve.pattern, 0.05, 3, solve.constraints.next);
  solve.clock.setDeadline(StageClock::Clock::time_point::min());
  const SweepOutcome outcome = solve.run();
  EXPECT_EQ(outcome.end, SweepEnd::kOutOfTime);
  EXPECT_EQ(outcome.sweeps, 1);
}

TEST(Sweeps, RodsThatTurnedOverDivergeButNotInTheLastResort) {
  for (const bool last_resort : {false, true}) {
    Solve solve(cloth(PinKind::kTop));
    for (int j = 0; j < 7; ++j) solve.constraints.next.add(solve.pattern.grid.index(7, j), Vec3(0.0, 0.0, 2.0 / 7.0));
    const SweepOutcome outcome = solve.run(last_resort);
    EXPECT_EQ(outcome.end == SweepEnd::kDiverged, !last_resort);
    EXPECT_EQ(outcome.within, last_resort);
  }
}

TEST(Sweeps, NumbersThatAreNotFiniteDiverge) {
  for (const bool last_resort : {false, true}) {
    Solve solve(cloth(PinKind::kTop));
    solve.constraints.next.set(solve.pattern.grid.index(3, 3),
                               Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    const SweepOutcome outcome = solve.run(last_resort);
    EXPECT_EQ(outcome.end, SweepEnd::kDiverged);
    EXPECT_FALSE(outcome.within);
  }
}

// A monotone solve ends no worse than it began, whatever it was given.
TEST(Sweeps, TheLastResortMakesTheSumOfSquaresSmaller) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Solve solve(cloth(PinKind::kTopCorners), 4);
    shake(solve.pattern, 0.3, seed, solve.constraints.next);
    solve.constraints.checkStrings(true);
    const double before = solve.constraints.merit(solve.constraints.rodsResidual());
    solve.run(true);
    solve.constraints.checkStrings(true);
    EXPECT_LT(solve.constraints.merit(solve.constraints.rodsResidual()), before) << seed;
  }
}

TEST(SweepDamping, GrowsWithSweepsThatWentWrongUpToItsLargest) {
  SweepDamping damping(0.1);
  const double first = damping.at(1e-3);
  EXPECT_GT(first, 0.0);
  EXPECT_FALSE(damping.exhausted(1e-3));
  damping.worse();
  EXPECT_GT(damping.at(1e-3), first);
  for (int k = 0; k < 100; ++k) damping.worse();
  EXPECT_TRUE(damping.exhausted(1e-3));
  for (int k = 0; k < 400; ++k) damping.better();
  EXPECT_EQ(damping.at(1e-3), first);
}

TEST(SweepDamping, VanishesWithTheResidual) {
  const SweepDamping damping(0.1);
  EXPECT_EQ(damping.at(2e-6), 2.0 * damping.at(1e-6));
  EXPECT_EQ(damping.at(0.0), 0.0);
}

TEST(StallWatch, WhatHalvesGoesOnAndWhatStandsEnds) {
  StallWatch halves, stands;
  double residual = 1.0;
  int stalled_at = 0;
  for (int sweep = 1; sweep <= 100; ++sweep) {
    EXPECT_FALSE(halves.stalls(sweep, residual)) << sweep;
    residual *= 0.5;
    if (stalled_at == 0 && stands.stalls(sweep, 1.0)) stalled_at = sweep;
  }
  EXPECT_GT(stalled_at, 1);
  EXPECT_LT(stalled_at, 100);
}

}  // namespace
}  // namespace curtain
