// SPDX-License-Identifier: BSD-3-Clause
//
// Carriers on a rail move as mechanics says: against what can be worked out by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "curtain_sim/simulator.h"
#include "simulator/rail_scenes.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kGravity;

void makeSeconds(Simulator& simulator, double seconds) {
  const auto frames = static_cast<int>(std::lround(seconds * simulator.scene().solver.frame_rate));
  for (int frame = 0; frame < frames; ++frame) simulator.step();
}

// Along the rail, of all of the cloth and its carriers [N s].
double momentumX(const Simulator& simulator) {
  std::vector<Vec3> velocities;
  simulator.copyVelocities(velocities);
  double sum = 0.0;
  for (std::size_t n = 0; n < velocities.size(); ++n) {
    const NodeIndex node{static_cast<int>(n) / simulator.columns(), static_cast<int>(n) % simulator.columns()};
    sum += simulator.mass(node) * velocities[n].x();
  }
  return sum;
}

// The cloth hangs plumb, so the whole weight rests on the rail; the cloth is as heavy as its carriers.
TEST(CarrierOnAnIncline, SlipsAtTheAngleOfFriction) {
  const double friction = 0.3;
  for (const double share : {0.99, 1.01}) {
    Simulator simulator(curtain_test::slideScene(0.2, share * friction, friction));
    const double from = curtain_test::carrierX(simulator, 0);
    makeSeconds(simulator, 2.0);
    const double way = curtain_test::carrierX(simulator, 0) - from;
    // Beyond it the excess of 1 % of mu g moves it by g cos^2 0.01 mu t^2 / 2.
    const double expected = share > 1.0 ? 0.5 * kGravity * 0.01 * friction / (1.0 + 0.09) * 4.0 : 0.0;
    EXPECT_NEAR(way, expected, 0.05 * expected + 1e-9) << "at " << share << " of mu";
    curtain_test::expectOnRail(simulator);
  }
}

// With hardly any cloth the acceleration along the rail is g (sin - mu cos).
TEST(CarrierOnAnIncline, AcceleratesByWeightLessFriction) {
  for (const double friction : {0.0, 0.2}) {
    Simulator simulator(curtain_test::slideScene(1e-6, 0.5, friction));
    makeSeconds(simulator, 1.0);
    const double along = kGravity * (0.5 - friction) / std::sqrt(1.25);
    const double way = (simulator.position({0, 0}) - Vec3(0.0, 0.0, 2.0)).norm();
    EXPECT_NEAR(way, 0.5 * along, 1e-3 * along) << "mu " << friction;
  }
}

// A pendulum m below a carrier M that slides freely: omega^2 = g / l (1 + m / M). Of two columns in step, masses in a
// column: 3 rows weigh 1/4, 1/2 and 1/4 of it, so here all of the mass is put in the lowest row.
TEST(SlidingPendulum, SwingsAtItsFrequency) {
  Scene scene = curtain_test::slideScene(0.2, 0.0, 0.0);
  scene.cloth.rows = 2;  // half of the cloth's mass in either row
  Simulator simulator(scene);
  const double hung = simulator.mass({1, 0}), slides = simulator.mass({0, 0});
  ASSERT_NEAR(hung, 0.05, 1e-12);
  ASSERT_NEAR(slides, 0.15, 1e-12);
  const double omega = std::sqrt(kGravity / scene.cloth.height * (1.0 + hung / slides));
  // Pushed so that the common centre rests, from the middle of the rail.
  std::vector<Vec3> positions, velocities;
  simulator.copyPositions(positions);
  simulator.copyVelocities(velocities);
  const double speed = 1e-3 * omega * scene.cloth.height;
  for (std::size_t n = 0; n < positions.size(); ++n) {
    positions[n].x() += 2.0;
    velocities[n].x() = n < 2 ? -speed * hung / (hung + slides) : speed * slides / (hung + slides);
  }
  ASSERT_TRUE(simulator.setState(positions, velocities).empty());
  const double period = 2.0 * curtain_test::kPi / omega;
  ASSERT_TRUE(simulator.setFrameRate(100.0 / period).empty());  // 10 periods are 1000 frames
  for (int frame = 0; frame < 1000; ++frame) simulator.step();
  // Back where it began, by the phase that 1e-3 of the frequency would come to: 2 pi 10 1e-3 of an amplitude.
  const double off = simulator.position({1, 0}).x() - simulator.position({0, 0}).x();
  EXPECT_LT(std::abs(off), 1e-3 * 2.0 * curtain_test::kPi * 10.0 * 1e-3 * scene.cloth.height);
  EXPECT_NEAR(simulator.energy().kinetic, 0.5 * 2.0 * (hung * slides / (hung + slides)) * speed * speed,
              0.01 * hung * speed * speed);
}

// Six carriers that touch, drawn by the last one: F / (sum of masses), less mu g of what friction takes.
TEST(StackOfCarriers, MovesByForceOverTheSumOfMasses) {
  for (const double friction : {0.0, 0.05}) {
    Scene scene = curtain_test::railScene(2, 6, 1, 0.5, 4.0);
    scene.cloth.surface_density = 1e-6;
    scene.rail.carriers.mass = 0.2;
    scene.rail.carriers.friction = friction;
    scene.rail.drive = {100.0, 2.0};
    scene.rail.opening = 1.0;
    Simulator simulator(scene);
    std::vector<Vec3> positions, velocities;
    simulator.copyPositions(positions);
    simulator.copyVelocities(velocities);
    for (Vec3& position : positions) position.x() += 2.0;
    ASSERT_TRUE(simulator.setState(positions, velocities).empty());
    ASSERT_TRUE(simulator.setOpening(1.0).empty());
    const double from = curtain_test::carrierX(simulator, 5);
    constexpr double kTime = 0.5;
    makeSeconds(simulator, kTime);
    const double acceleration = 2.0 / (6 * 0.2) - friction * kGravity;
    const double expected = 0.5 * acceleration * kTime * kTime;
    EXPECT_NEAR(from - curtain_test::carrierX(simulator, 5), expected, 1e-3 * expected);
    EXPECT_NEAR(simulator.statistics().drive_force, 2.0, 1e-12);
    for (int k = 1; k < 6; ++k) {
      EXPECT_NEAR(curtain_test::carrierX(simulator, k) - curtain_test::carrierX(simulator, k - 1),
                  scene.rail.carriers.gap, 1e-12);
    }
  }
}

// Nothing but the drive pushes along a level rail without friction, whatever cloth and carriers do to each other.
TEST(CurtainOnALevelRail, GetsTheMomentumOfTheDrive) {
  Scene scene = curtain_test::railScene(12, 17, 4, 0.8, 4.0);
  scene.rail.carriers.friction = 0.0;
  scene.rail.drive = {100.0, 0.5};
  scene.rail.opening = 0.5;
  Simulator simulator(scene);
  std::vector<Vec3> positions, velocities;
  simulator.copyPositions(positions);
  simulator.copyVelocities(velocities);
  for (Vec3& position : positions) position.x() += 1.0;
  ASSERT_TRUE(simulator.setState(positions, velocities).empty());
  ASSERT_TRUE(simulator.setOpening(0.0).empty());
  constexpr double kTime = 0.4;  // it has not arrived by then
  makeSeconds(simulator, kTime);
  EXPECT_NEAR(momentumX(simulator), -0.5 * kTime, 1e-3 * 0.5 * kTime);  // it gathers towards the left
  curtain_test::expectOnRail(simulator);
}

TEST(CarrierOnAnArc, KeepsItsSpeed) {
  Scene scene = curtain_test::slideScene(1e-6, 0.0, 0.0);
  scene.rail.path = {
      {{0.0, 0.0, 2.0}, {}}, {{1.0, 0.0, 2.0}, {}}, {{1.5, 0.5, 2.0}, Vec3(1.0, 0.5, 2.0)}, {{1.5, 3.0, 2.0}, {}}};
  Simulator simulator(scene);
  std::vector<Vec3> positions, velocities;
  simulator.copyPositions(positions);
  simulator.copyVelocities(velocities);
  for (Vec3& velocity : velocities) velocity = Vec3(1.0, 0.0, 0.0);
  ASSERT_TRUE(simulator.setState(positions, velocities).empty());
  makeSeconds(simulator, 2.5);
  simulator.copyVelocities(velocities);
  EXPECT_NEAR(velocities[0].y(), 1.0, 1e-3);
  EXPECT_NEAR(velocities[0].x(), 0.0, 1e-12);
  const double arc = 0.5 * 0.5 * curtain_test::kPi;
  EXPECT_NEAR(simulator.position({0, 0}).y(), 0.5 + 2.5 - 1.0 - arc, 3e-3);
}

// It gets there at its speed, stays there, and needs no more than its force.
TEST(Drive, OpensAndShutsAtItsSpeed) {
  Scene scene = curtain_test::railScene(8, 25, 4, 1.5, 1.0);
  scene.air.inside = scene.air.border = scene.air.corner = 0.5;
  Simulator simulator(scene);
  EXPECT_NEAR(simulator.statistics().opening, 0.0, 1e-12);
  const double way = curtain_test::carrierX(simulator, 24) - 6 * scene.rail.carriers.gap;
  ASSERT_TRUE(simulator.setOpening(1.0).empty());
  makeSeconds(simulator, 0.5 * way / scene.rail.drive.speed);
  EXPECT_NEAR(simulator.statistics().opening, 0.5, 0.02);
  makeSeconds(simulator, 0.6 * way / scene.rail.drive.speed);
  EXPECT_NEAR(simulator.statistics().opening, 1.0, 1e-9);
  EXPECT_LE(simulator.statistics().drive_force, scene.rail.drive.force);
  for (int column = 0; column < 25; column += 4) {
    EXPECT_NEAR(curtain_test::carrierX(simulator, column), column / 4 * scene.rail.carriers.gap, 1e-9);
  }
  ASSERT_TRUE(simulator.setOpening(0.0).empty());
  makeSeconds(simulator, 1.1 * way / scene.rail.drive.speed);
  EXPECT_NEAR(simulator.statistics().opening, 0.0, 1e-9);
  EXPECT_LE(simulator.statistics().weft_stretch_max, scene.solver.stretch_tolerance);
  EXPECT_EQ(simulator.statistics().last_resort_substeps, 0);
}

TEST(Drive, OfAPairMovesBothMasters) {
  Scene scene = curtain_test::railScene(6, 24, 1, 1.6, 1.0);
  scene.rail.carriers.columns = {0, 4, 8, 11, 12, 15, 19, 23};
  scene.rail.masters = {11, 12};
  scene.rail.opening = 0.1;
  Simulator simulator(scene);
  EXPECT_NEAR(simulator.statistics().opening, 0.1, 1e-12);
  // One cloth: the masters part by what lies between them, and no further.
  ASSERT_TRUE(simulator.setOpening(1.0).empty());
  makeSeconds(simulator, 1.0);
  const double between = 1.6 / 23;
  EXPECT_LE(curtain_test::carrierX(simulator, 12) - curtain_test::carrierX(simulator, 11), between * 1.001);
  EXPECT_LE(simulator.statistics().weft_stretch_max, scene.solver.stretch_tolerance);
}

TEST(Drive, LetsGo) {
  Scene scene = curtain_test::railScene(4, 9, 4, 1.0, 1.0);
  Simulator simulator(scene);
  ASSERT_TRUE(simulator.setOpening(1.0).empty());
  EXPECT_TRUE(simulator.drives());
  makeSeconds(simulator, 1.0);
  simulator.releaseDrive();
  EXPECT_FALSE(simulator.drives());
  makeSeconds(simulator, 1.0);
  EXPECT_EQ(simulator.statistics().drive_force, 0.0);
  EXPECT_LT(simulator.statistics().opening, 0.9);
}

TEST(Drive, RefusesWhatIsOutOfRange) {
  Simulator on_rail(curtain_test::railScene(4, 9, 4, 1.0, 1.0));
  for (const double opening : {-0.1, 1.1, std::nan("")}) EXPECT_EQ(on_rail.setOpening(opening).size(), 1U);
  EXPECT_EQ(on_rail.setDrive({0.0, 1.0}).size(), 1U);
  EXPECT_EQ(on_rail.setDrive({1.0, -1.0}).size(), 1U);
  EXPECT_FALSE(on_rail.drives());
  Simulator pinned(curtain_test::flatScene(4, 9));
  EXPECT_EQ(pinned.setOpening(0.5).size(), 1U);
}

TEST(CurtainOnARail, FallsAsleepAndWakesWhenItIsOpened) {
  Scene scene = curtain_test::railScene(8, 13, 4, 0.8, 0.6);
  scene.air.inside = scene.air.border = scene.air.corner = 2.0;
  Simulator simulator(scene);
  for (int second = 0; second < 60 && simulator.statistics().asleep_frames == 0; ++second) makeSeconds(simulator, 1.0);
  ASSERT_GT(simulator.statistics().asleep_frames, 0);
  ASSERT_TRUE(simulator.setOpening(1.0).empty());
  makeSeconds(simulator, 4.0);
  EXPECT_NEAR(simulator.statistics().opening, 1.0, 1e-9);
}

TEST(Rail, IsDrawnByPointsOnIt) {
  Scene scene = curtain_test::flatScene(3, 9, 1.0, 2.0);
  scene.rail.path = {{{0.0, 0.0, 2.0}, {}}, {{0.5, 0.0, 2.0}, {}}, {{0.8, 0.3, 2.0}, Vec3(0.5, 0.3, 2.0)}};
  const Simulator simulator(scene);
  const std::vector<Vec3> points = simulator.railPoints(0.1);
  const RailPath path(scene.rail.path);
  ASSERT_EQ(points.size(), static_cast<std::size_t>(std::ceil(path.length() / 0.1)) + 1);
  EXPECT_EQ(points.front(), Vec3(0.0, 0.0, 2.0));
  EXPECT_LT((points.back() - Vec3(0.8, 0.3, 2.0)).norm(), 1e-12);
  for (std::size_t k = 1; k < points.size(); ++k) {
    EXPECT_LE((points[k] - points[k - 1]).norm(), 0.1);
    EXPECT_LT((path.at(path.nearest(points[k])).point - points[k]).norm(), 1e-12);
  }
  EXPECT_EQ(simulator.carriers().size(), 3u);
  EXPECT_TRUE(Simulator(curtain_test::flatScene(3, 9, 1.0, 2.0)).railPoints(0.1).empty());
}

TEST(FastenedCarrier, StaysWhereItStarts) {
  Scene scene = curtain_test::railScene(6, 13, 4, 0.8, 2.0);
  scene.rail.carriers.friction = 0.0;
  scene.pins.kind = PinKind::kList;
  scene.pins.nodes = {{0, 4}};
  scene.rail.drive = {1.0, 3.0};
  Simulator simulator(scene);
  const Vec3 from = simulator.position({0, 4});
  ASSERT_TRUE(simulator.setOpening(1.0).empty());
  makeSeconds(simulator, 2.0);
  EXPECT_EQ(simulator.position({0, 4}), from);
  EXPECT_NEAR(curtain_test::carrierX(simulator, 12), from.x() + 2.0 * scene.rail.carriers.gap, 1e-9);
  curtain_test::expectOnRail(simulator);
}

}  // namespace
}  // namespace curtain
