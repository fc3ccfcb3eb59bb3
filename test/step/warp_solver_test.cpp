// SPDX-License-Identifier: BSD-3-Clause
//
// The rods alone come to their lengths, along the directions given.
#include "step/warp_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "testing.h"

namespace curtain {
namespace {

Scene sceneOf(int rows, int columns, PinKind pins) {
  Scene scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  scene.pins.kind = pins;
  return scene;
}

struct WarpBench {
  explicit WarpBench(const Scene& scene) : pattern(makePattern(scene)), state(makeInitialState(scene, pattern)) {
    warp.assign(pattern.grid);
    scratch.assign(pattern.grid);
    setWarpDirections(pattern.grid, state.position, warp.direction);
  }
  void shake(double size, unsigned seed) { curtain_test::shake(pattern, size, seed, state.position); }
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
  Vec3 momentum(const Field3& before) const {
    Vec3 sum = Vec3::Zero();
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
      sum += pattern.mass[n] * (state.position.at(n) - before.at(n));
    }
    return sum;
  }

  ClothPattern pattern;
  ClothState state;
  LinkSet warp;
  LineScratch scratch;
};

// Newton ends quadratically: from a relative violation of 1e-1 five iterations leave rounding, 1e-16 * rows, times
// the condition of a column of that height (~ rows^2).
TEST(WarpSolver, BringsEveryRodToItsLength) {
  WarpBench bench(sceneOf(20, 13, PinKind::kTop));
  bench.shake(0.005, 3);
  EXPECT_GT(warpStretch(bench.pattern, bench.state.position).longer, 1e-3);
  for (int iteration = 0; iteration < 6; ++iteration) EXPECT_TRUE(bench.newton().sound);
  const Stretch stretch = warpStretch(bench.pattern, bench.state.position);
  EXPECT_LT(stretch.longer, 1e-12);
  EXPECT_LT(stretch.shorter, 1e-12);
}

// Constraint forces come in pairs: without pins the centre of mass stays. 1e-16 * nodes of rounding.
TEST(WarpSolver, FreeColumnsKeepTheirMomentum) {
  WarpBench bench(sceneOf(20, 13, PinKind::kNone));
  bench.shake(0.005, 4);
  const Field3 before = bench.state.position;
  for (int iteration = 0; iteration < 6; ++iteration) bench.newton();
  EXPECT_LT(warpStretch(bench.pattern, bench.state.position).longer, 1e-12);
  EXPECT_LT(bench.momentum(before).norm(), 1e-15);
}

// The move of every node is along the directions given, whatever the rods' present directions are: the multipliers
// alone reproduce it.
TEST(WarpSolver, MovesAlongTheGivenDirections) {
  WarpBench bench(sceneOf(9, 5, PinKind::kTop));
  bench.shake(0.02, 5);
  const Field3 before = bench.state.position;
  for (int iteration = 0; iteration < 3; ++iteration) bench.newton();
  const Field3 solved = bench.state.position;
  bench.state.position = before;
  for (int block = 0; block < warpBlockCount(bench.pattern.grid); ++block)
    pullWarp(bench.warpLine(), block, bench.warpLine().links.multiplier);
  for (std::size_t n = 0; n < bench.pattern.grid.size(); ++n) {
    EXPECT_LT((bench.state.position.at(n) - solved.at(n)).norm(), 1e-14);
  }
}

TEST(WarpSolver, ReportsARodThatTurnedOver) {
  WarpBench bench(sceneOf(2, 3, PinKind::kTop));
  const std::size_t node = bench.pattern.grid.index(1, 1);
  bench.state.position.set(node, bench.state.position.at(node) + Vec3(0.0, 0.0, 4.0));
  EXPECT_FALSE(bench.newton().sound);
}

TEST(WarpSolver, ProjectedVelocitiesKeepTheRodsLengths) {
  WarpBench bench(sceneOf(15, 6, PinKind::kTop));
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

}  // namespace
}  // namespace curtain
