// SPDX-License-Identifier: BSD-3-Clause
//
// What the paper's scheme promises, whatever it is given: rods that keep their length, momentum, energy that is bounded
// at any step, and pins that move evenly. Whole scenes: test/simulator/paper_test.cpp.
#include "methods/paper/paper_solver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kEps;
using curtain_test::Random;

constexpr int kRows = 12;
constexpr int kColumns = 7;

struct Pinning {
  const char* name;
  PinKind kind;
  std::vector<NodeIndex> nodes;
};

// The last ones: free above and below, two and more pins in a column with one rod, some and an odd number between them,
// whole columns.
const std::vector<Pinning>& pinnings() {
  static const std::vector<Pinning> all = {
      {"top", PinKind::kTop, {}},
      {"left", PinKind::kLeft, {}},
      {"two corners", PinKind::kTopCorners, {}},
      {"none", PinKind::kNone, {}},
      {"hem", PinKind::kList, {{kRows - 1, 0}, {kRows - 1, 3}}},
      {"inside a column", PinKind::kList, {{4, 2}}},
      {"two in a column", PinKind::kList, {{2, 1}, {9, 1}, {3, 4}, {4, 4}, {0, 5}, {2, 5}, {11, 5}}},
  };
  return all;
}

struct Bench {
  explicit Bench(const Pinning& pins, int rows = kRows) {
    Scene scene = curtain_test::flatScene(rows, kColumns);
    scene.pins.kind = pins.kind;
    scene.pins.nodes = pins.nodes;
    pattern = makePattern(scene);
    state = makeInitialState(scene, pattern);
    solver = std::make_unique<PaperSolver>(pattern);
    force.assign(pattern.grid.size(), 0.0);
    forces.force = &force;
  }
  void setWeight(const Vec3& gravity) {
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) force.set(n, pattern.mass[n] * gravity);
  }
  void forEachNode(const std::function<void(std::size_t)>& visit) const {
    for (int i = 0; i < pattern.grid.rows; ++i) {
      for (int j = 0; j < pattern.grid.columns; ++j) visit(pattern.grid.index(i, j));
    }
  }
  void stir(Random& random, double speed) {
    forEachNode([&](std::size_t n) {
      if (pattern.inverse_mass[n] > 0.0) state.velocity.set(n, random.inBox(speed));
    });
  }
  // What is not accepted is not made: the cloth stops, as in a frame (simulator/frame_loop.cpp).
  bool substep(double h) {
    const bool accepted = solver->substep(forces, h, nullptr, state, clock).accepted;
    if (!accepted) state.velocity.assign(pattern.grid.size(), 0.0);
    return accepted;
  }
  double kinetic() const {
    double sum = 0.0;
    forEachNode([&](std::size_t n) { sum += 0.5 * pattern.mass[n] * state.velocity.at(n).squaredNorm(); });
    return sum;
  }
  double potential(const Vec3& gravity) const {
    double sum = 0.0;
    forEachNode([&](std::size_t n) { sum -= pattern.mass[n] * gravity.dot(state.position.at(n)); });
    return sum;
  }
  Vec3 massTimes(const Field3& value) const {
    Vec3 sum = Vec3::Zero();
    forEachNode([&](std::size_t n) { sum += pattern.mass[n] * value.at(n); });
    return sum;
  }
  // The rod below (row, column) lies halfway between two pins: one pass does not keep it.
  bool givesWay(int row, int column) const {
    int above = -1, below = -1;
    for (int i = 0; i <= row; ++i) above = pattern.isPinned({i, column}) ? i : above;
    for (int i = pattern.grid.rows - 1; i > row; --i) below = pattern.isPinned({i, column}) ? i : below;
    return above >= 0 && below >= 0 && row == above + (below - above) / 2;
  }
  // Largest relative error of a rod that is kept.
  double rodError() const {
    double worst = 0.0;
    for (int i = 0; i + 1 < pattern.grid.rows; ++i) {
      for (int j = 0; j < pattern.grid.columns; ++j) {
        if (!givesWay(i, j)) worst = std::max(worst, std::abs(length(i, j) - 1.0));
      }
    }
    return worst;
  }
  double length(int row, int column) const {  // over the rest length
    const std::size_t node = pattern.grid.index(row, column), below = pattern.grid.index(row + 1, column);
    return (state.position.at(below) - state.position.at(node)).norm() / pattern.warp_rest[below];
  }

  ClothPattern pattern;
  ClothState state;
  std::unique_ptr<PaperSolver> solver;
  Field3 force;
  NodeForces forces;
  StageClock clock;
};

// Random forces up to 1000 times the weight, at steps from fine to far too coarse. Rods are rounded as coordinates of 1
// m are.
TEST(PaperSolver, RodsKeepTheirLengthWhateverPulls) {
  for (const Pinning& pins : pinnings()) {
    for (const double h : {1e-3, 1.0 / 60.0, 0.2}) {
      Bench bench(pins);
      Random random(7);
      bench.stir(random, 3.0);
      for (int step = 0; step < 200; ++step) {
        const double pull = std::pow(10.0, random.between(-1.0, 3.0));
        bench.forEachNode(
            [&](std::size_t n) { bench.force.set(n, 9.81 * pull * bench.pattern.mass[n] * random.inBox(1.0)); });
        bench.substep(h);
        double size = 1.0;  // [m]; loose columns may be far away
        bench.forEachNode([&](std::size_t n) { size = std::max(size, bench.state.position.at(n).norm()); });
        ASSERT_LE(bench.rodError(), 1e-12 * size) << pins.name << ", h " << h << ", step " << step;
      }
    }
  }
}

// The one rod between two pins that one pass can't keep: both its ends hang from a pin by rods that are kept, so it is
// no longer than the pins are apart and those rods together.
TEST(PaperSolver, TheRodBetweenTwoPinsIsBounded) {
  const Pinning pins{"two", PinKind::kList, {{2, 3}, {9, 3}}};
  Bench bench(pins);
  Random random(11);
  ASSERT_TRUE(bench.givesWay(5, 3));
  bench.stir(random, 3.0);
  for (int step = 0; step < 300; ++step) {
    bench.forEachNode([&](std::size_t n) { bench.force.set(n, 1e4 * bench.pattern.mass[n] * random.inBox(1.0)); });
    bench.substep(1e-3);
    EXPECT_LE(bench.length(5, 3), 7.0 + 6.0 + 1e-9);
  }
}

// Weight alone, pins at rest: the energy stays below what it was and the potential energy, the worst of which is the
// cloth on its head: rods and wefts do no work. Rounding: of sums of n terms of size m g x 1 m.
TEST(PaperSolver, WeightAloneNeverRaisesTheEnergy) {
  const Vec3 gravity(0.0, 0.0, -9.81);
  for (const Pinning& pins : pinnings()) {
    if (pins.kind == PinKind::kNone) continue;
    for (const double h : {1e-3, 1.0 / 60.0, 0.2}) {
      Bench bench(pins);
      bench.setWeight(gravity);
      Random random(3);
      bench.stir(random, 3.0);
      double energy = bench.kinetic() + bench.potential(gravity);
      for (int step = 0; step < 500; ++step) {
        bench.substep(h);
        const double potential = bench.potential(gravity);
        const double now = bench.kinetic() + potential;
        const double rounding = kRows * kColumns * kEps * 9.81 * 2.0;
        ASSERT_LE(now, std::max(energy, potential) + rounding) << pins.name << ", h " << h << ", step " << step;
        energy = now;
      }
    }
  }
}

// Without pins: rods, wefts and the bound of the energy keep the momentum, and the centre of mass goes with it.
TEST(PaperSolver, FreeClothKeepsItsMomentum) {
  for (const double h : {1e-3, 1.0 / 60.0}) {
    Bench bench(pinnings()[3]);
    const Vec3 gravity(1.0, 2.0, -9.81);
    bench.setWeight(gravity);
    Random random(5);
    bench.stir(random, 3.0);
    double mass = 0.0;
    bench.forEachNode([&](std::size_t n) { mass += bench.pattern.mass[n]; });
    Vec3 momentum = bench.massTimes(bench.state.velocity), place = bench.massTimes(bench.state.position);
    for (int step = 0; step < 300; ++step) {
      ASSERT_TRUE(bench.substep(h));
      momentum += h * mass * gravity;
      place += h * momentum;
      // n terms, each rounded as a coordinate; velocities as a coordinate over h.
      const double size = 1.0 + place.norm() / mass;
      const double rounding = kRows * kColumns * (step + 1.0) * kEps * mass * size;
      ASSERT_LE((bench.massTimes(bench.state.velocity) - momentum).norm(), rounding / h) << h << " " << step;
      ASSERT_LE((bench.massTimes(bench.state.position) - place).norm(), rounding * (step + 1.0)) << h << " " << step;
    }
  }
}

// Without gravity a cloth at rest stays, and one that flies goes on straight.
TEST(PaperSolver, FreeFallMovesNoRod) {
  Bench bench(pinnings()[3]);
  const Vec3 gravity(0.0, 0.0, -9.81), velocity(0.3, 0.2, 0.1);
  bench.setWeight(gravity);
  bench.forEachNode([&](std::size_t n) { bench.state.velocity.set(n, velocity); });
  const Field3 start = bench.state.position;
  const double h = 1e-3;
  const int steps = 100;
  for (int step = 0; step < steps; ++step) ASSERT_TRUE(bench.substep(h));
  const Vec3 fallen = steps * h * velocity + 0.5 * steps * (steps + 1) * h * h * gravity;  // symplectic Euler's sum
  bench.forEachNode([&](std::size_t n) {
    EXPECT_LE((bench.state.position.at(n) - start.at(n) - fallen).norm(), steps * steps * kRows * kEps);
  });
}

// A pin is where its velocity takes it after every substep, and the rods with it.
TEST(PaperSolver, MovedPinsGoEvenly) {
  for (const Pinning& pins : pinnings()) {
    Bench bench(pins);
    const Field3 start = bench.state.position;
    const Vec3 velocity(0.5, -0.25, 1.0);
    const double h = 1.0 / 960.0;
    const auto forEachPin = [&](const std::function<void(std::size_t)>& visit) {
      for (int i = 0; i < kRows; ++i) {
        for (int j = 0; j < kColumns; ++j) {
          if (bench.pattern.isPinned({i, j})) visit(bench.pattern.grid.index(i, j));
        }
      }
    };
    forEachPin([&](std::size_t n) { bench.state.velocity.set(n, velocity); });
    for (int step = 1; step <= 16; ++step) {
      ASSERT_TRUE(bench.substep(h));
      forEachPin([&](std::size_t n) {
        EXPECT_LE((bench.state.position.at(n) - start.at(n) - step * h * velocity).norm(), 16 * kEps * 2.0)
            << pins.name;
        EXPECT_EQ(bench.state.velocity.at(n), velocity);
      });
      EXPECT_LE(bench.rodError(), 1e-12) << pins.name;
    }
  }
}

// Eq. (5), read with the pin for the node above: one rod turns as a pendulum, to first order in the step.
TEST(PaperSolver, OneRodIsAPendulum) {
  const auto period = [](double h) {
    Bench bench(pinnings()[0], 2);
    bench.setWeight(Vec3(0.0, 0.0, -9.81));
    const std::size_t node = bench.pattern.grid.index(1, 0), above = bench.pattern.grid.index(0, 0);
    for (int j = 0; j < kColumns; ++j) {  // released at 0.1 rad
      bench.state.position.set(bench.pattern.grid.index(1, j), bench.state.position.at(bench.pattern.grid.index(0, j)) +
                                                                   Vec3(0.0, std::sin(0.1), -std::cos(0.1)));
    }
    double before = 0.1, time = 0.0;
    for (;; time += h) {
      EXPECT_TRUE(bench.substep(h));
      const double now = bench.state.position.at(node).y() - bench.state.position.at(above).y();
      if (now <= 0.0) return 4.0 * (time + h * before / (before - now));
      before = now;
    }
  };
  const double exact = 2.0 * curtain_test::kPi / std::sqrt(9.81) * (1.0 + 0.01 / 16.0);  // next term: 11/3072 A^4
  // Symplectic Euler starts half a step late.
  EXPECT_NEAR(period(1e-3), exact, 4.0 * 1e-3);
  EXPECT_NEAR(period(1e-4), exact, 4.0 * 1e-4);
}

}  // namespace
}  // namespace curtain
