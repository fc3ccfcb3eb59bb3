// SPDX-License-Identifier: BSD-3-Clause
//
// An obstacle that waits for jammed cloth is told where it is, not where it is going, with how far it is behind; and
// everything that is measured of it is measured there. Where nothing is jammed none waits. Cloth that is stopped does
// not sleep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "cloth/cloth.h"
#include "curtain_sim/simulator.h"
#include "simulator/obstacle_lag.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::ballAt;
using curtain_test::flatScene;
using curtain_test::kPi;

constexpr double kInside = 1e-6;  // [m], from which a node counts as inside, as of Simulator::piercings()

// Depth of the deepest of the points in an obstacle that is where the simulator says.
double deepest(const Simulator& simulator, const std::vector<Vec3>& points) {
  const Pose& pose = simulator.obstaclePose(0);
  double depth = 0.0;
  for (const Vec3& point : points) {
    const Vec3 local = pose.orientation.conjugate() * (point - pose.position);
    SurfacePoint surface;
    if (simulator.obstacleShape(0).query(local, local, 0.0, surface)) depth = std::max(depth, -surface.distance);
  }
  return depth;
}

// A sheet pinned above and below, taut: nothing can be pushed through its plane.
Scene pinnedSheet() {
  Scene scene = flatScene(16, 16, 0.8, 0.8);
  scene.pins.kind = PinKind::kList;
  for (int j = 0; j < 16; ++j) {
    scene.pins.nodes.push_back({0, j});
    scene.pins.nodes.push_back({15, j});
  }
  return scene;
}

// A ball without friction that goes 0.21 m towards the sheet in half a second.
Scene jam() {
  Scene scene = pinnedSheet();
  ObstacleParams ball = ballAt({0.4, -0.16, 0.42}, 0.15);
  ball.friction = 0.0;
  ball.motion = {{0.0, ball.pose}, {0.5, {Vec3(0.4, 0.05, 0.42), Rotation::Identity()}}};
  scene.obstacles.push_back(ball);
  return scene;
}

TEST(WaitingObstacles, AreToldWhereTheyAre) {
  Simulator simulator(jam());
  std::vector<Vec3> nodes;
  FineMesh mesh;
  double node = 0.0, fold = 0.0;
  for (int frame = 1; frame <= 60; ++frame) {
    simulator.step();
    simulator.copyPositions(nodes);
    simulator.copyFineMesh(mesh);
    node = std::max(node, deepest(simulator, nodes));
    fold = std::max(fold, deepest(simulator, mesh.positions));
    const double there = std::min(-0.16 + 0.42 * frame / 60.0, 0.05);
    EXPECT_NEAR(simulator.obstacleTarget(0).position.y(), there, 1e-12) << "frame " << frame;
    EXPECT_NEAR(simulator.obstacleLag(0), there - simulator.obstaclePose(0).position.y(), 1e-12) << "frame " << frame;
  }
  std::printf("deepest node %.2e m, fold %.2e m; %.4f m behind\n", node, fold, simulator.obstacleLag(0));
  EXPECT_LE(node, kInside);
  EXPECT_LE(fold, kInside);
  EXPECT_GT(simulator.obstacleLag(0), 0.15);
  Simulator restored(jam());
  ASSERT_TRUE(restored.restore(simulator.snapshot()).empty());
  EXPECT_EQ(restored.obstaclePose(0).position, simulator.obstaclePose(0).position);
  EXPECT_EQ(restored.obstacleLag(0), simulator.obstacleLag(0));
}

TEST(WaitingObstacles, AreNotThereBeforeTheStep) {
  Scene scene = pinnedSheet();
  scene.obstacles.push_back(ballAt({0.4, -0.5, 0.4}, 0.1));
  Simulator simulator(scene);
  const Vec3 start(0.4, -0.5, 0.4), goal(0.4, -0.5, 0.6);
  simulator.setObstaclePose(0, {goal, Rotation::Identity()});
  EXPECT_EQ(simulator.obstaclePose(0).position, start);
  EXPECT_EQ(simulator.obstacleTarget(0).position, goal);
  EXPECT_NEAR(simulator.obstacleLag(0), 0.2, 1e-15);
  simulator.step();
  EXPECT_EQ(simulator.obstaclePose(0).position, goal);
  EXPECT_EQ(simulator.obstacleLag(0), 0.0);
  simulator.setObstaclePose(0, {start, Rotation::Identity()}, true);
  EXPECT_EQ(simulator.obstaclePose(0).position, start) << "a jump is at once";
  EXPECT_EQ(simulator.obstacleLag(0), 0.0);
}

// Of a substep that was made over a part of its path the obstacle has made that part: torques are about where it is. Of
// one that was not accepted it has made none.
TEST(ObstacleLag, TheMotionOfASubstepIsWhatWasMade) {
  Scene scene = jam();
  double rate = scene.solver.frame_rate = 50.0;
  const FrameTimes times(rate);
  const ClothPattern pattern = makePattern(scene);
  const Workers alone(1);
  ObstacleSet obstacles(scene, shapesBy(resolveMeshUrl));
  ClothContact contact(pattern, scene.contact, obstacles, 1e-3, alone);
  ObstacleLag lag(pattern, times, obstacles, contact);
  const Field3 position = makeInitialState(scene, pattern).position;
  const auto place = [&] { return obstacles.moving(0).after.translation.y(); };
  SubstepPlan plan;
  plan.h = 0.01;
  obstacles.beginFrame(0.02);  // 8.4 mm in two substeps
  lag.setSubstep(plan, 0.0, position);
  EXPECT_NEAR(place(), -0.16 + 4.2e-3, 1e-12);
  EXPECT_NEAR(lag.substepMade(0.25, plan.h), 0.0075, 1e-15);
  EXPECT_NEAR(place(), -0.16 + 1.05e-3, 1e-12);
  lag.setSubstep(plan, 0.01, position);
  EXPECT_NEAR(place(), -0.16 + 5.25e-3, 1e-12);
  lag.endFrame(0.5);  // that substep was not accepted, and there is no time for another
  EXPECT_NEAR(place(), -0.16 + 1.05e-3, 1e-12);
  EXPECT_EQ(place(), obstacles.reached(0).position.y());
  EXPECT_NEAR(obstacles.lag(0), 7.35e-3, 1e-12);
}

// Of each of ten frames a quarter is made, of later ones all: in the cloth's time the obstacle moves at most 1.5 times
// as fast as it was led, and makes up 5 mm a frame.
TEST(ObstacleLag, WhatFellBehindIsHardlyFasterThanItWas) {
  Scene scene = flatScene(4, 4);
  scene.obstacles.push_back(ballAt({0.0, -1.0, 0.0}, 0.1));
  ObstacleSet obstacles(scene, shapesBy(resolveMeshUrl));
  double target = -1.0, before = -1.0, fastest = 0.0;
  int frames = 0;
  while (frames < 100 && (frames == 0 || obstacles.lag(0) > 1e-12)) {
    const double share = frames < 10 ? 0.25 : 1.0;
    obstacles.setPose(0, {Vec3(0.0, target += 0.01, 0.0), Rotation::Identity()}, false);
    obstacles.beginFrame(0.0);
    obstacles.endFrame(share);
    const double now = obstacles.reached(0).position.y();
    fastest = std::max(fastest, (now - before) / share);
    before = now;
    ++frames;
  }
  EXPECT_NEAR(fastest, 0.015, 1e-12);
  // 2.5 mm of the first frame, 3.75 of the other nine, so 63.75 are left.
  EXPECT_EQ(frames, 10 + 13);
}

// A blade that turns five times a second in a curtain, which gives way: no node is in it by brute force, so none is by
// the statistics.
TEST(WaitingObstacles, SpinWithNoNodeInThem) {
  Scene scene = flatScene(24, 20, 1.2, 0.9);
  scene.air.inside = scene.air.border = scene.air.corner = 0.2;
  ObstacleParams blade = ballAt({0.45, -0.2, 0.6}, 0.0);
  blade.shape = ShapeKind::kBox;
  blade.size = Vec3(0.7, 0.03, 0.2);
  scene.obstacles.push_back(blade);
  Simulator simulator(scene);
  std::vector<Vec3> nodes;
  FineMesh mesh;
  double node = 0.0, fold = 0.0;
  for (int frame = 1; frame <= 120; ++frame) {
    const Eigen::AngleAxisd turned(2.0 * kPi * 5.0 * frame / 60.0, Vec3::UnitZ());
    simulator.setObstaclePose(0, {blade.pose.position, Rotation(turned)});
    simulator.step();
    simulator.copyPositions(nodes);
    simulator.copyFineMesh(mesh);
    node = std::max(node, deepest(simulator, nodes));
    fold = std::max(fold, deepest(simulator, mesh.positions));
  }
  const Statistics& s = simulator.statistics();
  std::printf("waited %.3f s, deepest node %.2e m, fold %.2e m, by the statistics %.2e m\n", s.obstacles_waited, node,
              fold, s.penetration_max);
  EXPECT_LE(node, kInside);
  EXPECT_LE(fold, kInside);
  EXPECT_NEAR(s.penetration_max, node, 1e-12);
}

// A taut sheet stands before the ball only because its substeps are stopped.
TEST(StoppedCloth, DoesNotSleep) {
  Simulator stopped(jam()), at_rest(pinnedSheet());
  while (!at_rest.statistics().asleep || stopped.time() < 4.0) {
    stopped.step();
    at_rest.step();
    ASSERT_LT(at_rest.time(), 10.0) << "it does not fall asleep";
  }
  EXPECT_GT(stopped.statistics().stops_last, 0);
  EXPECT_FALSE(stopped.statistics().asleep);
  EXPECT_EQ(at_rest.statistics().stops_last, 0);
  EXPECT_EQ(stopped.statistics().quality, FrameQuality::kStopped);
  EXPECT_EQ(at_rest.statistics().quality, FrameQuality::kResolved);
}

// A ribbon with a heavy hem, 250 times its own weight, that a bar is pushed into. The hem hangs free: nothing is
// jammed. (With 21 rows, links as long as the bar's radius, it is jammed at some places of the bar.)
TEST(WaitingObstacles, PushAHeavyHemAside) {
  for (const int rows : {31, 41}) {
    Scene scene = flatScene(rows, 3, 1.0, 0.5);
    scene.cloth.surface_density = 0.2;
    scene.hem.line_density = 50.0;
    scene.air.inside = scene.air.border = scene.air.corner = 5.0;
    const Rotation lying(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitY()));
    ObstacleParams bar = ballAt(Vec3::Zero(), 0.05);
    bar.shape = ShapeKind::kCylinder;
    bar.length = 1.0;
    bar.friction = 0.0;
    bar.pose = {scene.hang.from + Vec3(0.25, -0.1, -0.4), lying};
    bar.motion = {{0.0, bar.pose}, {4.0, {bar.pose.position + Vec3(0.0, 0.35, 0.0), lying}}};
    scene.obstacles = {bar};
    Simulator simulator(scene);
    while (simulator.time() < 6.0) simulator.step();
    Vec3 mean = Vec3::Zero();
    for (int frame = 0; frame < 120; ++frame) {
      simulator.step();
      mean += simulator.contactWrench(0).force / 120.0;
    }
    // The strap leaves the bar plumb, 0.05 m beyond it; above it slopes from the pins past it.
    const double pull = 25.1 * 9.81, slope = std::atan2(0.25, 0.4) + std::asin(0.052 / std::hypot(0.25, 0.4));
    const Statistics& s = simulator.statistics();
    std::printf(
        "%d rows: waited %.3f s, %d last resorts; pushed back by %.3f across and %.3f down of what it must be\n", rows,
        s.obstacles_waited, static_cast<int>(s.last_resort_substeps), mean.y() / (-pull * std::sin(slope)),
        mean.z() / (-pull * (1.0 - std::cos(slope))));
    EXPECT_EQ(s.obstacles_waited, 0.0) << rows;
    EXPECT_EQ(s.last_resort_substeps, 0) << rows;
    EXPECT_NEAR(mean.y(), -pull * std::sin(slope), 0.03 * pull) << rows;
    EXPECT_NEAR(mean.z(), -pull * (1.0 - std::cos(slope)), 0.03 * pull) << rows;
  }
}

// A sheet by both ends of one column, straight and taut, over a box that drives off without friction: the sheet slides
// off. The column that can't move is held; its equations have no solution.
TEST(WaitingObstacles, LeaveWhatTwoPinsHold) {
  Scene scene = flatScene(8, 8, 2.0, 2.0);
  scene.cloth.surface_density = 0.2;
  scene.hang.from = Vec3(-1.0, 1.0, 1.3);
  scene.hang.to = Vec3(1.0, 1.0, 1.3);
  scene.hang.tilt = 0.5 * kPi;
  scene.pins.kind = PinKind::kList;
  scene.pins.nodes = {{0, 0}, {7, 0}};
  scene.air.inside = scene.air.border = scene.air.corner = 0.5;
  ObstacleParams box = ballAt({-0.1, 0.0, 0.9}, 0.1);
  box.shape = ShapeKind::kBox;
  box.size = Vec3(0.8, 0.6, 0.4);
  box.friction = 0.0;
  box.motion = {{1.0, box.pose}, {3.0, {Vec3(5.9, 0.0, 0.9), Rotation::Identity()}}};
  scene.obstacles = {box};
  Simulator simulator(scene);
  while (simulator.time() < 4.0) simulator.step();
  EXPECT_EQ(simulator.statistics().obstacles_waited, 0.0);
  EXPECT_EQ(simulator.statistics().stops, 0);
  EXPECT_NEAR(simulator.obstaclePose(0).position.x(), 5.9, 1e-9);
}

}  // namespace
}  // namespace curtain
