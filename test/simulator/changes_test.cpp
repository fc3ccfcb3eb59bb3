// SPDX-License-Identifier: BSD-3-Clause
//
// What users change between frames: their length, and where the cloth is. And the account of its energy.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "chains.h"
#include "curtain_sim/simulator.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain_test {
namespace {

using namespace curtain;

Scene tilted() {
  Scene scene = flatScene(12, 10);
  scene.hang.tilt = 0.8;
  return scene;
}

std::vector<Vec3> positionsOf(const Simulator& simulator) {
  std::vector<Vec3> positions;
  simulator.copyPositions(positions);
  return positions;
}

double balance(const Work& work) {
  return work.kinetic - (work.gravity + work.elastic + work.forces + work.pins + work.obstacles);
}

}  // namespace

TEST(FrameRate, MayChangeBeforeEveryFrame) {
  Simulator simulator(tilted());
  double time = 0.0;
  Random random(5);
  for (int frame = 0; frame < 200; ++frame) {
    const double rate = std::exp(random.between(std::log(5.0), std::log(1000.0)));
    ASSERT_TRUE(simulator.setFrameRate(rate).empty());
    simulator.step();
    time += 1.0 / rate;
    ASSERT_NEAR(simulator.time(), time, 1e-9);
    ASSERT_LE(simulator.statistics().warp_stretch, 1e-3);
  }
}

// Substeps of one length, cut into frames in two ways: the same motion, but for the rounding of their lengths.
TEST(FrameRate, DoesNotChangeTheMotion) {
  Scene scene = tilted();
  scene.solver.method = Method::kLeapfrog;
  scene.solver.substeps = 8;
  Simulator even(scene);
  scene.solver.substeps = 8;
  Simulator other(scene);
  for (int frame = 0; frame < 60; ++frame) even.step();
  // 1/60 s in 8 substeps; then the same in one frame of 1/120 s in 8, and one more: half as long, so as exact or more.
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_TRUE(other.setFrameRate(120.0).empty());
    other.step();
    other.step();
  }
  EXPECT_NEAR(other.time(), even.time(), 1e-12);
  const std::vector<Vec3> a = positionsOf(even), b = positionsOf(other);
  double apart = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) apart = std::max(apart, (a[n] - b[n]).norm());
  // Order 2: the swing's 8 substeps are 4e-5 m off after a second (docs/bench), of 2 m; here it is 1 m, of which a part
  // is this.
  EXPECT_LE(apart, 4e-5);
  EXPECT_GT(apart, 0.0);
}

// What is asked of the error is asked of every second, however many frames it has.
TEST(FrameRate, KeepsThePositionTolerance) {
  Scene scene = tilted();
  scene.solver.position_tolerance = 1e-5;
  Simulator even(scene);
  Simulator other(scene);
  for (int frame = 0; frame < 60; ++frame) {
    even.step();
    other.step();
  }
  ASSERT_TRUE(other.setFrameRate(10.0).empty());
  for (int frame = 0; frame < 10; ++frame) other.step();
  for (int frame = 0; frame < 60; ++frame) even.step();
  const std::vector<Vec3> a = positionsOf(even), b = positionsOf(other);
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]).squaredNorm();
  // Each may be off by the tolerance, RMS, in each of the two seconds.
  EXPECT_LE(std::sqrt(sum / static_cast<double>(a.size())), 2.0 * 2.0 * 1e-5);
}

TEST(FrameRate, OutOfRangeChangesNothing) {
  Simulator simulator(tilted());
  for (const double rate : {0.0, -60.0, 0.5, 20000.0, std::numeric_limits<double>::quiet_NaN()}) {
    const std::vector<Problem> problems = simulator.setFrameRate(rate);
    ASSERT_EQ(problems.size(), 1U) << rate;
    EXPECT_EQ(problems[0].key, "solver.frame_rate");
    EXPECT_EQ(simulator.scene().solver.frame_rate, 60.0);
  }
}

TEST(State, IsTakenAsGiven) {
  Simulator simulator(tilted());
  for (int frame = 0; frame < 30; ++frame) simulator.step();
  std::vector<Vec3> positions = positionsOf(simulator), velocities;
  simulator.copyVelocities(velocities);
  Simulator other(tilted());
  ASSERT_TRUE(other.setState(positions, velocities).empty());
  EXPECT_EQ(positionsOf(other), positions);
  EXPECT_NEAR(energyOf(other), energyOf(simulator), 1e-12);
  for (int frame = 0; frame < 30; ++frame) {
    simulator.step();
    other.step();
  }
  // Not the same bits: leapfrog's velocities were half a step old, and the tensions are found anew. But the same
  // motion, to what a step of it is off.
  double apart = 0.0;
  const std::vector<Vec3> a = positionsOf(simulator), b = positionsOf(other);
  for (std::size_t n = 0; n < a.size(); ++n) apart = std::max(apart, (a[n] - b[n]).norm());
  EXPECT_LE(apart, 2e-3);
}

TEST(State, WakesTheClothAndItsReaders) {
  Scene scene = flatScene(12, 10);
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  Simulator simulator(scene);
  while (!simulator.statistics().asleep && simulator.time() < 10.0) simulator.step();
  ASSERT_TRUE(simulator.statistics().asleep);
  const std::uint64_t revision = simulator.revision();
  std::vector<Vec3> positions = positionsOf(simulator);
  positions.back().y() += 0.2;
  ASSERT_TRUE(simulator.setState(positions, std::vector<Vec3>(positions.size(), Vec3::Zero())).empty());
  EXPECT_NE(simulator.revision(), revision);
  EXPECT_FALSE(simulator.statistics().asleep);
  EXPECT_GT(simulator.statistics().warp_stretch, 0.1);
  simulator.step();
  EXPECT_LE(simulator.statistics().warp_stretch, 1e-3);
}

TEST(State, ThatIsNoneChangesNothing) {
  Simulator simulator(tilted());
  simulator.step();
  const std::uint64_t hash = simulator.stateHash();
  std::vector<Vec3> positions = positionsOf(simulator), velocities(positions.size(), Vec3::Zero());
  EXPECT_EQ(simulator.setState({}, velocities)[0].key, "positions");
  velocities[7].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(simulator.setState(positions, velocities)[0].key, "velocities[7]");
  velocities[7].x() = 2e9;
  EXPECT_EQ(simulator.setState(positions, velocities)[0].key, "velocities[7]");
  EXPECT_EQ(simulator.stateHash(), hash);
}

// A swing without air: all that it loses and gains is the fall of its weight.
TEST(Work, OfASwingIsThatOfItsWeight) {
  Scene scene = chainScene(10, 45.0);
  scene.solver.substeps = 32;
  Simulator simulator(scene);
  simulator.countWork(true);
  const Energy start = simulator.energy();
  makeFrames(simulator, 60);
  const Work work = simulator.work();
  const Energy end = simulator.energy();
  EXPECT_EQ(work.forces, 0.0);
  EXPECT_EQ(work.pins, 0.0);
  // Half a substep late: the power of the weight, at most m g v, for half of 1/1920 s.
  double mass = 0.0;
  for (int i = 1; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) mass += simulator.mass({i, j});
  }
  const double late = mass * 9.81 * std::sqrt(2.0 * end.kinetic / mass) / (2.0 * 1920.0);
  EXPECT_NEAR(work.gravity, start.potential - end.potential, late);
  EXPECT_NEAR(work.kinetic, end.kinetic - start.kinetic, late);
  EXPECT_NEAR(balance(work), 0.0, late);
  EXPECT_GT(work.gravity, 100.0 * late);
}

// Nodes that nothing holds together: a force's work is known.
TEST(Work, OfAForceIsWhatItGivesAFreeCloth) {
  Scene scene = flatScene(2, 2);
  scene.pins.kind = PinKind::kNone;
  scene.gravity = Vec3::Zero();
  DragParams drag;
  drag.id = "hand";
  drag.node = NodeIndex{0, 0};
  drag.force = Vec3(0.0, 0.3, 0.0);
  drag.radius = 10.0;
  scene.drag.push_back(drag);
  Simulator simulator(scene);
  simulator.countWork(true);
  for (int frame = 0; frame < 30; ++frame) simulator.step();
  const Work work = simulator.work();
  EXPECT_GT(work.forces, 0.01);
  EXPECT_NEAR(work.forces, work.kinetic, 1e-3 * work.forces);  // links that turn take a little
}

// A rail that carries the cloth along gives it its kinetic energy.
TEST(Work, OfPinsIsWhatTheyCarry) {
  Scene scene = flatScene(12, 10);
  scene.solver.substeps = 16;
  Simulator simulator(scene);
  simulator.countWork(true);
  for (int frame = 0; frame < 120; ++frame) {
    const double t = (frame + 1) / 60.0;
    for (int j = 0; j < 10; ++j) simulator.movePin({0, j}, Vec3(j / 9.0, 0.1 * t * t, 1.0));
    simulator.step();
  }
  const Work work = simulator.work();
  EXPECT_GT(work.pins, 0.0);
  // What is left over: the rail's speed jumps with every frame, by 0.2/60 m/s, and its blows are inelastic: m v dv / 2
  // each.
  const double blows = 0.5 * 0.2 * 0.4 * 0.4;
  EXPECT_LE(balance(work), 0.02 * work.pins);
  EXPECT_GE(balance(work), -blows - 0.02 * work.pins);
}

TEST(Work, IsNotCountedUnlessAskedFor) {
  Simulator simulator(tilted());
  for (int frame = 0; frame < 10; ++frame) simulator.step();
  EXPECT_EQ(simulator.work().kinetic, 0.0);
  EXPECT_EQ(simulator.work().gravity, 0.0);
}

}  // namespace curtain_test
