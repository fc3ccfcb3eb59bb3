// SPDX-License-Identifier: BSD-3-Clause
//
// An obstacle that waits for jammed cloth is told where it is, not where it is going, with how far it is behind; and
// everything that is measured of it is measured there. Cloth that was stopped and sleeps is no cloth at rest.
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
  ObstacleSet obstacles(scene, resolveMeshUrl);
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

// A blade that turns five times a second into a curtain and has to wait: no node is in it by brute force, so none is by
// the statistics.
TEST(WaitingObstacles, PenetrationIsMeasuredWhereTheyAre) {
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
  EXPECT_GT(s.obstacles_waited, 0.0);
  EXPECT_LE(node, kInside);
  EXPECT_LE(fold, kInside);
  EXPECT_NEAR(s.penetration_max, node, 1e-12);
}

// A ball that is put 5 cm into the taut sheet. Asleep the cloth makes no substeps, so the stops are those before.
TEST(StoppedCloth, IsKnownInItsSleep) {
  Scene scene = pinnedSheet();
  scene.obstacles.push_back(ballAt({0.4, -0.1, 0.42}, 0.15));
  Simulator stopped(scene), at_rest(pinnedSheet());
  for (Simulator* const simulator : {&stopped, &at_rest}) {
    EXPECT_EQ(simulator->statistics().stops_last, 0);
    while (simulator->statistics().asleep_frames < 10) {
      simulator->step();
      ASSERT_LT(simulator->time(), 10.0) << "it does not fall asleep";
    }
  }
  EXPECT_GT(stopped.statistics().stops_last, 0);
  EXPECT_EQ(at_rest.statistics().stops_last, 0);
}

}  // namespace
}  // namespace curtain
