// SPDX-License-Identifier: BSD-3-Clause
//
// The line solvers alone: rods come to their lengths along their directions, strings only pull, nothing that is in
// order is touched.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solver/warp_solver.h"
#include "solver/weft_solver.h"

namespace curtain {
namespace {

Scene sceneOf(int rows, int columns, PinKind pins, bool closed = false) {
  Scene scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  scene.cloth.closed = closed;
  scene.pins.kind = pins;
  return scene;
}

struct Bench {
  explicit Bench(const Scene& scene)
      : pattern(makePattern(scene)), state(makeInitialState(scene, pattern)), weft_solver(pattern.grid) {
    warp.assign(pattern.grid);
    weft.assign(pattern.grid);
    scratch.assign(pattern.grid);
    setWarpDirections(pattern.grid, state.position, warp.direction);
    WeftSolver::setDirections(pattern.grid, state.position, weft.direction);
  }
  void shake(double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> move(-size, size);
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
      const Vec3 step(move(random), move(random), move(random));
      if (pattern.inverse_mass[n] > 0.0) state.position.add(n, step);
    }
  }
  LineSolve warpLine() { return {pattern, pattern.inverse_mass, warp, state.position}; }
  // One Newton iteration on all columns.
  LineOutcome newton() {
    LineOutcome all;
    for (int block = 0; block < warpBlockCount(pattern.grid); ++block) {
      const LineOutcome outcome = warpNewton(warpLine(), scratch, block);
      all.residual = std::max(all.residual, outcome.residual);
      all.sound = all.sound && outcome.sound;
    }
    return all;
  }
  LineSolve weftLine() { return {pattern, pattern.inverse_mass, weft, state.position}; }
  Vec3 momentum(const Field3& before) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
      sum += pattern.mass[n] * (state.position.at(n) - before.at(n));
    }
    return sum;
  }

  ClothPattern pattern;
  ClothState state;
  LinkSet warp, weft;
  LineScratch scratch;
  WeftSolver weft_solver;
};

// Newton ends quadratically: from a relative violation of 1e-1 five iterations leave rounding, 1e-16 * rows, times
// the condition of a column of that height (~ rows^2).
TEST(WarpSolver, BringsEveryRodToItsLength) {
  Bench bench(sceneOf(20, 13, PinKind::kTop));
  bench.shake(0.005, 3);
  EXPECT_GT(warpStretch(bench.pattern, bench.state.position).longer, 1e-3);
  for (int iteration = 0; iteration < 6; ++iteration) EXPECT_TRUE(bench.newton().sound);
  const Stretch stretch = warpStretch(bench.pattern, bench.state.position);
  EXPECT_LT(stretch.longer, 1e-12);
  EXPECT_LT(stretch.shorter, 1e-12);
}

// Constraint forces come in pairs: without pins the centre of mass stays. 1e-16 * nodes of rounding.
TEST(WarpSolver, FreeColumnsKeepTheirMomentum) {
  Bench bench(sceneOf(20, 13, PinKind::kNone));
  bench.shake(0.005, 4);
  const Field3 before = bench.state.position;
  for (int iteration = 0; iteration < 6; ++iteration) bench.newton();
  EXPECT_LT(warpStretch(bench.pattern, bench.state.position).longer, 1e-12);
  EXPECT_LT(bench.momentum(before).norm(), 1e-15);
}

// The move of every node is along the directions given, whatever the rods' present directions are: the multipliers
// alone reproduce it.
TEST(WarpSolver, MovesAlongTheGivenDirections) {
  Bench bench(sceneOf(9, 5, PinKind::kTop));
  bench.shake(0.02, 5);
  const Field3 before = bench.state.position;
  for (int iteration = 0; iteration < 3; ++iteration) bench.newton();
  const Field3 solved = bench.state.position;
  bench.state.position = before;
  applyWarpMultipliers(bench.warpLine());
  for (std::size_t n = 0; n < bench.pattern.grid.size(); ++n) {
    EXPECT_LT((bench.state.position.at(n) - solved.at(n)).norm(), 1e-14);
  }
}

TEST(WarpSolver, ReportsARodThatTurnedOver) {
  Bench bench(sceneOf(2, 3, PinKind::kTop));
  const std::size_t node = bench.pattern.grid.index(1, 1);
  bench.state.position.set(node, bench.state.position.at(node) + Vec3(0.0, 0.0, 4.0));
  EXPECT_FALSE(bench.newton().sound);
}

TEST(WarpSolver, ProjectedVelocitiesKeepTheRodsLengths) {
  Bench bench(sceneOf(15, 6, PinKind::kTop));
  Field3 velocity;
  velocity.assign(bench.pattern.grid.size(), 0.0);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> speed(-1.0, 1.0);
  for (std::size_t n = 0; n < bench.pattern.grid.size(); ++n) {
    if (bench.pattern.inverse_mass[n] > 0.0) velocity.set(n, Vec3(speed(random), speed(random), speed(random)));
  }
  const LineSolve line{bench.pattern, bench.pattern.inverse_mass, bench.warp, velocity};
  warpProjectVelocity(line, bench.scratch, 0);
  // A second solve finds nothing left but rounding: 1e-16 / rest, times the column's condition.
  EXPECT_LT(warpProjectVelocity(line, bench.scratch, 0).residual, 1e-11);
}

class WeftSolverOf : public ::testing::TestWithParam<bool> {};

TEST_P(WeftSolverOf, ShortensLongLinksAndLeavesSlackOnes) {
  Bench bench(sceneOf(6, 24, PinKind::kNone, GetParam()));
  bench.shake(0.004, 8);
  const Field3 before = bench.state.position;
  EXPECT_GT(weftStretch(bench.pattern, bench.state.position), 1e-2);
  for (int sweep = 0; sweep < 20; ++sweep) bench.weft_solver.solve(bench.weftLine(), 1e-12, 1e-12, false);
  // Strings may keep the compliance's share of their load s (w_a + w_b): at most the strain shaken in, 0.2, summed over
  // the 24 links of a row.
  EXPECT_LT(weftStretch(bench.pattern, bench.state.position), kWeftCompliance * 0.2 * 24);
  EXPECT_LT(bench.momentum(before).norm(), 1e-15);
  int slack = 0;
  for (std::size_t n = 0; n < bench.pattern.grid.size(); ++n) {
    EXPECT_GE(bench.weft.multiplier[n], 0.0);
    if (bench.weft.multiplier[n] == 0.0) ++slack;
  }
  EXPECT_GT(slack, 0);
}

TEST_P(WeftSolverOf, DoesNotTouchAClothWithoutATautLink) {
  Scene scene = sceneOf(6, 24, PinKind::kNone, GetParam());
  scene.hang.to = Vec3(0.6, 0.0, 2.2);
  scene.hang.radius = 0.1;
  Bench bench(scene);
  const Field3 before = bench.state.position;
  const LineOutcome outcome = bench.weft_solver.solve(bench.weftLine(), 1e-12, 1e-12, false);
  EXPECT_EQ(outcome.residual, 0.0);
  EXPECT_EQ(bench.state.position.x, before.x);
  EXPECT_EQ(bench.state.position.y, before.y);
  EXPECT_EQ(bench.state.position.z, before.z);
}

INSTANTIATE_TEST_SUITE_P(OpenAndClosed, WeftSolverOf, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "Closed" : "Open"; });

// A string that pulled and has become too short lets go, and what it pulled is given back.
TEST(WeftSolver, TakesBackAPullThatIsNotNeeded) {
  Bench bench(sceneOf(2, 4, PinKind::kNone));
  const Field3 before = bench.state.position;
  bench.weft.multiplier[bench.pattern.grid.index(0, 2)] = 0.01;
  WeftSolver::applyMultipliers(bench.weftLine());
  for (int sweep = 0; sweep < 10; ++sweep) bench.weft_solver.solve(bench.weftLine(), 1e-13, 1e-13, false);
  EXPECT_NEAR(bench.weft.multiplier[bench.pattern.grid.index(0, 2)], 0.0, 1e-9);
  for (int j = 0; j < 4; ++j) {
    const std::size_t n = bench.pattern.grid.index(0, j);
    EXPECT_LT((bench.state.position.at(n) - before.at(n)).norm(), 1e-8);
  }
}

// Between two pins a straight row's constraint matrix is singular; the compliance keeps the solve finite and small.
TEST(WeftSolver, SurvivesAStraightRowBetweenPins) {
  Bench bench(sceneOf(2, 30, PinKind::kTopCorners));
  for (int j = 1; j < 29; ++j) bench.state.position.add(bench.pattern.grid.index(0, j), Vec3(1e-4, 0.0, -1e-3));
  for (int sweep = 0; sweep < 30; ++sweep) {
    EXPECT_TRUE(bench.weft_solver.solve(bench.weftLine(), 1e-6, 1e-6, false).sound);
  }
  EXPECT_LT(weftStretch(bench.pattern, bench.state.position), 1e-3);
}

}  // namespace
}  // namespace curtain
