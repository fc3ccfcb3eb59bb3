// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth on belts and lifts: a speed that is smooth does not make it slip, and what it presses with is its weight less
// what the lift gives way, in each frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "curtain_sim/simulator.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kGravity;
using curtain_test::kPi;
using curtain_test::massOf;

constexpr double kFloorFriction = 0.5;

// A square of cloth that lies on a wide floor.
Scene sheetOnFloor(double rate) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = 13;
  scene.cloth.height = scene.cloth.width = 0.3;
  scene.hang.from = Vec3(-0.15, 0.15, scene.contact.thickness);
  scene.hang.to = Vec3(0.15, 0.15, scene.contact.thickness);
  scene.hang.tilt = 0.5 * kPi;
  scene.pins.kind = PinKind::kNone;
  scene.solver.frame_rate = rate;
  ObstacleParams floor;
  floor.name = "floor";
  floor.shape = ShapeKind::kBox;
  floor.size = Vec3(20.0, 2.0, 0.2);
  floor.pose.position = Vec3(0.0, 0.0, -0.1);
  floor.friction = kFloorFriction;
  scene.obstacles.push_back(floor);
  return scene;
}

double middle(const Simulator& simulator) {
  std::vector<Vec3> nodes;
  simulator.copyPositions(nodes);
  double sum = 0.0;
  for (const Vec3& node : nodes) sum += node.x();
  return sum / static_cast<double>(nodes.size());
}

// How a belt is told where to be.
enum class Told { kByPoses, kByKeys };

// A belt that goes to and fro, at up to 0.45 g: below mu g cloth sticks to it. Half a second at rest first. It turns
// back at poses: between two of them a turn is not known of.
void expectSticks(double rate, Told told) {
  const double most = 0.45 * kGravity, turns = 0.5 * kPi;
  const auto belt = [&](double time) {
    const double t = std::max(0.0, time - 0.5), a = most / (turns * turns);
    return Vec3(a * (1.0 - std::cos(turns * t)), 0.0, -0.1);
  };
  Scene scene = sheetOnFloor(rate);
  const int frames = static_cast<int>(std::lround(10.5 * rate));
  for (int k = 0; told == Told::kByKeys && k <= 210; ++k)
    scene.obstacles[0].motion.push_back({0.05 * k, {belt(0.05 * k), Rotation::Identity()}});
  Simulator simulator(scene);
  double worst = 0.0;
  for (int k = 0; k < frames; ++k) {
    if (told == Told::kByPoses) simulator.setObstaclePose(0, {belt((k + 1) / rate), Rotation::Identity()});
    simulator.step();
    worst = std::max(worst, std::abs(middle(simulator) - simulator.obstaclePose(0).position.x()));
  }
  std::printf("%g Hz, %s: %.2e m of creep\n", rate, told == Told::kByPoses ? "poses" : "keys", worst);
  EXPECT_LT(worst, 1e-3) << rate;
}

// One that speeds up for good, as the scene says or by the poses of a robot.
void expectStaysPut(double rate, bool by_poses) {
  const double most = 0.45 * kGravity;
  Scene scene = sheetOnFloor(rate);
  scene.obstacles[0].size.x() = 1000.0;
  if (!by_poses) scene.obstacles[0].acceleration = Vec3(most, 0.0, 0.0);
  Simulator simulator(scene);
  const auto belt = [&](double t) { return Pose{Vec3(0.5 * most * t * t, 0.0, -0.1), Rotation::Identity()}; };
  for (int k = 0; k < static_cast<int>(5.0 * rate); ++k) {
    if (by_poses) simulator.setObstaclePose(0, belt((k + 1) / rate));
    simulator.step();
  }
  const double creep = std::abs(middle(simulator) - simulator.obstaclePose(0).position.x());
  std::printf("%g Hz, %s: %.2e m of creep\n", rate, by_poses ? "poses" : "acceleration", creep);
  EXPECT_LT(creep, 1e-3) << rate;
}

TEST(Belt, TakesClothAlongForGood) {
  for (const double rate : {30.0, 60.0, 240.0}) {
    expectStaysPut(rate, true);
    expectStaysPut(rate, false);
  }
}

TEST(Belt, TakesClothAlongBelowTheFrictionBound) {
  for (const double rate : {30.0, 60.0, 240.0}) {
    expectSticks(rate, Told::kByPoses);
    expectSticks(rate, Told::kByKeys);
  }
}

// Above it the cloth slips at mu g.
TEST(Belt, LeavesClothBehindAboveTheFrictionBound) {
  Scene scene = sheetOnFloor(60.0);
  scene.obstacles[0].acceleration = Vec3(0.8 * kGravity, 0.0, 0.0);
  Simulator simulator(scene);
  for (int k = 0; k < 60; ++k) simulator.step();
  EXPECT_NEAR(middle(simulator), 0.5 * kFloorFriction * kGravity, 0.02 * 0.5 * kFloorFriction * kGravity);
}

// A lift that goes down with 0.3 g: each frame feels m (g - a), though frames have different numbers of substeps.
void expectForce(double rate, bool by_poses) {
  const double down = 0.3 * kGravity;
  Scene scene = sheetOnFloor(rate);
  if (!by_poses) scene.obstacles[0].acceleration = Vec3(0.0, 0.0, -down);
  Simulator simulator(scene);
  const double wanted = massOf(simulator) * (kGravity - down);
  double worst = 0.0;
  for (int k = 0; k < static_cast<int>(1.5 * rate); ++k) {
    const double t = (k + 1) / rate;
    if (by_poses) simulator.setObstaclePose(0, {Vec3(0.0, 0.0, -0.1 - 0.5 * down * t * t), Rotation::Identity()});
    simulator.step();
    if (t > 0.25) worst = std::max(worst, std::abs(-simulator.contactWrench(0).force.z() - wanted) / wanted);
  }
  std::printf("%g Hz, %s: worst frame off by %.1e of the force\n", rate, by_poses ? "poses" : "acceleration", worst);
  EXPECT_LT(worst, 0.01) << rate;
}

TEST(Lift, FeelsTheSameForceInEachFrame) {
  for (const double rate : {30.0, 60.0, 240.0}) {
    expectForce(rate, true);
    expectForce(rate, false);
  }
}

// A turntable that spins up by a scene's keys takes cloth along, whatever the frame rate; its spin is that of the
// curve.
TEST(Turntable, SpinsUpWithoutSlip) {
  for (const double rate : {25.0, 60.0}) {
    Scene scene = sheetOnFloor(rate);
    for (int k = 0; k <= 20; ++k) {
      const double t = 0.1 * k;
      scene.obstacles[0].motion.push_back(
          {t, {Vec3(0.0, 0.0, -0.1), Rotation(Eigen::AngleAxisd(0.5 * t * t, Vec3::UnitZ()))}});
    }
    Simulator simulator(scene);
    std::vector<Vec3> before, after;
    simulator.copyPositions(before);
    for (int k = 0; k < static_cast<int>(2.0 * rate); ++k) simulator.step();
    simulator.copyPositions(after);
    const Rotation turned = simulator.obstaclePose(0).orientation;
    EXPECT_NEAR(Eigen::AngleAxisd(turned).angle(), 2.0, 1e-12);
    for (std::size_t n = 0; n < before.size(); ++n)
      EXPECT_LT((turned * before[n] - after[n]).norm(), 1e-3) << "node " << n << ", " << rate << " Hz";
  }
}

}  // namespace
}  // namespace curtain
