// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth and obstacles: both layers of nodes stay outside, whatever the shape and however it moves; friction is
// Coulomb's.
#include <gtest/gtest.h>

#include <cmath>

#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain {
namespace {

// Depth of the deepest of the points inside an obstacle that stands at its pose.
double deepest(const Simulator& simulator, int obstacle, const std::vector<Vec3>& points) {
  const Pose& pose = simulator.obstaclePose(obstacle);
  double depth = 0.0;
  for (const Vec3& point : points) {
    const Vec3 local = pose.orientation.conjugate() * (point - pose.position);
    SurfacePoint surface;
    if (simulator.obstacleShape(obstacle).query(local, local, 0.0, surface)) depth = std::max(depth, -surface.distance);
  }
  return depth;
}

Scene curtainAnd(const ObstacleParams& obstacle) {
  Scene scene;
  scene.cloth.rows = 30;
  scene.cloth.columns = 24;
  scene.hang.to = Vec3(0.7, 0.0, 2.2);
  scene.air.inside = scene.air.border = scene.air.corner = 0.1;
  scene.obstacles.push_back(obstacle);
  return scene;
}

ObstacleParams obstacleOf(ShapeKind shape) {
  ObstacleParams obstacle;
  obstacle.name = "obstacle";
  obstacle.shape = shape;
  switch (shape) {
    case ShapeKind::kSphere:
      obstacle.radius = 0.25;
      break;
    case ShapeKind::kBox:
      obstacle.size = Vec3(0.4, 0.3, 0.5);
      break;
    case ShapeKind::kCylinder:
    case ShapeKind::kCapsule:
      obstacle.radius = 0.15;
      obstacle.length = 0.4;
      break;
    case ShapeKind::kMesh:
      obstacle.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/icosphere.stl";
      obstacle.scale = Vec3(0.25, 0.25, 0.25);
      break;
    case ShapeKind::kPlane:
      break;
  }
  return obstacle;
}

class Pushing : public ::testing::TestWithParam<ShapeKind> {};

// Through the curtain and back at up to 1 m/s, turning: no node of either layer is inside at any frame's end.
TEST_P(Pushing, KeepsBothLayersOutside) {
  ObstacleParams obstacle = obstacleOf(GetParam());
  if (GetParam() == ShapeKind::kPlane) {
    // A wall that hangs behind the rail, its free side towards +y, and swings its lower part into the curtain.
    const Eigen::Quaterniond plumb(Eigen::AngleAxisd(-1.5707963, Vec3::UnitX()));
    const Eigen::Quaterniond leaning(Eigen::AngleAxisd(-1.2, Vec3::UnitX()));
    obstacle.motion = {{0.0, {Vec3(0.0, -0.05, 2.3), plumb}},
                       {1.5, {Vec3(0.0, -0.05, 2.3), leaning}},
                       {3.0, {Vec3(0.0, -0.05, 2.3), plumb}}};
  } else {
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(1.2, Vec3(1.0, 1.0, 0.3).normalized()));
    obstacle.motion = {{0.0, {Vec3(0.3, -0.7, 1.0), Eigen::Quaterniond::Identity()}},
                       {1.2, {Vec3(0.4, 0.4, 1.1), turned}},
                       {2.4, {Vec3(0.3, -0.7, 0.9), Eigen::Quaterniond::Identity()}},
                       {3.0, {Vec3(0.3, -0.7, 0.9), Eigen::Quaterniond::Identity()}}};
  }
  Simulator simulator(curtainAnd(obstacle));
  std::vector<Vec3> nodes;
  FineMesh mesh;
  double worst_node = 0.0, worst_fold = 0.0;
  int contacts = 0;
  for (int frame = 0; frame < 180; ++frame) {
    simulator.step();
    simulator.copyPositions(nodes);
    simulator.copyFineMesh(mesh);
    worst_node = std::max(worst_node, deepest(simulator, 0, nodes));
    worst_fold = std::max(worst_fold, deepest(simulator, 0, mesh.positions));
    contacts = std::max(contacts, simulator.statistics().contacts);
  }
  const Statistics& s = simulator.statistics();
  std::printf("contacts %d, deepest node %.2e m, fold %.2e m, warp %.1e, weft %.1e, unsettled %ld\n", contacts,
              worst_node, worst_fold, s.warp_stretch_max, s.weft_stretch_max, static_cast<long>(s.unsettled));
  EXPECT_GT(contacts, 10);
  EXPECT_EQ(worst_node, 0.0);
  EXPECT_EQ(worst_fold, 0.0);
  EXPECT_TRUE(s.finite);
  EXPECT_LE(s.warp_stretch_max, 1e-3);
  EXPECT_LE(s.weft_stretch_max, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Shapes, Pushing,
                         ::testing::Values(ShapeKind::kSphere, ShapeKind::kBox, ShapeKind::kCylinder,
                                           ShapeKind::kCapsule, ShapeKind::kPlane, ShapeKind::kMesh));

// A sheet lying on an inclined plane, turned by angle about x.
Scene sheetOnIncline(double angle, double friction) {
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = 8;
  scene.cloth.height = scene.cloth.width = 0.5;
  scene.pins.kind = PinKind::kNone;
  const Eigen::Quaterniond lean(Eigen::AngleAxisd(angle, Vec3::UnitX()));
  scene.hang.tilt = 1.5707963267948966 - angle;
  scene.hang.from = Vec3(0.0, 0.0, 0.0) + lean * Vec3(0.0, 0.0, scene.contact.thickness);
  scene.hang.to = scene.hang.from + Vec3(0.5, 0.0, 0.0);
  ObstacleParams plane;
  plane.name = "incline";
  plane.shape = ShapeKind::kPlane;
  plane.pose.orientation = lean;
  plane.friction = friction;
  scene.obstacles.push_back(plane);
  return scene;
}

// Below the friction angle the sheet stays, above it slides with g (sin a - mu cos a). Bound 2 %: the first substep
// gathers the normal force, 1/60 s of 1 s.
TEST(Friction, IsCoulombs) {
  constexpr double kFriction = 0.4;  // angle 0.3805
  for (const double angle : {0.36, 0.40, 0.6}) {
    Simulator simulator(sheetOnIncline(angle, kFriction));
    const Vec3 start = simulator.position({4, 4});
    for (int frame = 0; frame < 60; ++frame) simulator.step();
    const double slid = (simulator.position({4, 4}) - start).norm();
    const double expected = 0.5 * 9.81 * std::max(0.0, std::sin(angle) - kFriction * std::cos(angle));
    EXPECT_NEAR(slid, expected, 0.02 * 0.5 * 9.81 * std::sin(angle)) << "angle " << angle;
  }
}

// A box that carries a sheet along does so by friction: it goes with it.
TEST(Friction, AMovingObstacleCarriesTheCloth) {
  Scene scene = sheetOnIncline(0.0, 0.5);
  scene.obstacles[0].motion = {{0.0, {Vec3::Zero(), Eigen::Quaterniond::Identity()}},
                               {2.0, {Vec3(1.0, 0.0, 0.0), Eigen::Quaterniond::Identity()}}};
  Simulator simulator(scene);
  const Vec3 start = simulator.position({4, 4});
  for (int frame = 0; frame < 120; ++frame) simulator.step();
  // It slips until it has gained 0.5 m/s at mu g: 0.5 v^2 / (mu g) = 26 mm behind.
  EXPECT_NEAR((simulator.position({4, 4}) - start).x(), 1.0 - 0.125 / (0.5 * 9.81), 0.01);
}

TEST(Obstacles, AnAbsentObstacleTouchesNothing) {
  ObstacleParams ball = obstacleOf(ShapeKind::kSphere);
  ball.pose.position = Vec3(0.35, 0.05, 1.0);
  Scene with = curtainAnd(ball);
  Scene without = with;
  without.obstacles.clear();
  Simulator absent(with), none(without);
  absent.setObstaclePresent(0, false);
  for (int frame = 0; frame < 30; ++frame) {
    absent.step();
    none.step();
  }
  EXPECT_EQ(absent.stateHash(), none.stateHash());
  // Back again inside the cloth it pushes it out.
  absent.setObstaclePose(0, ball.pose, true);
  absent.setObstaclePresent(0, true);
  for (int frame = 0; frame < 30; ++frame) absent.step();
  std::vector<Vec3> nodes;
  absent.copyPositions(nodes);
  EXPECT_EQ(deepest(absent, 0, nodes), 0.0);
  EXPECT_GT(absent.statistics().contacts_max, 0);
}

// A box that appears in the middle of the hanging cloth, with friction: the cloth comes off it, no link stays overlong.
TEST(Obstacles, ABoxThatAppearsInTheClothLetsItGo) {
  ObstacleParams box = obstacleOf(ShapeKind::kBox);
  box.friction = 0.3;
  box.pose.position = Vec3(0.35, 0.05, 0.9);
  Simulator simulator(curtainAnd(box));
  simulator.setObstaclePresent(0, false);
  for (int frame = 0; frame < 60; ++frame) simulator.step();
  simulator.setObstaclePose(0, box.pose, true);
  simulator.setObstaclePresent(0, true);
  for (int frame = 0; frame < 120; ++frame) simulator.step();
  std::vector<Vec3> nodes;
  simulator.copyPositions(nodes);
  EXPECT_EQ(deepest(simulator, 0, nodes), 0.0);
  EXPECT_LE(simulator.statistics().warp_stretch, 1e-3);
  EXPECT_LE(simulator.statistics().weft_stretch, 1e-3);
  EXPECT_GT(simulator.statistics().contacts_max, 10);
}

// Poses given frame by frame push as scripted motion does.
TEST(Obstacles, GivenPosesMoveTheObstacle) {
  ObstacleParams ball = obstacleOf(ShapeKind::kSphere);
  ball.motion = {{0.0, {Vec3(0.35, -0.6, 1.0), Eigen::Quaterniond::Identity()}},
                 {1.0, {Vec3(0.35, 0.2, 1.0), Eigen::Quaterniond::Identity()}}};
  Scene scripted = curtainAnd(ball);
  Scene given = scripted;
  given.obstacles[0].motion.clear();
  Simulator a(scripted), b(given);
  b.setObstaclePose(0, {Vec3(0.35, -0.6, 1.0), Eigen::Quaterniond::Identity()}, true);
  for (int frame = 1; frame <= 60; ++frame) {
    b.setObstaclePose(0, {Vec3(0.35, -0.6 + 0.8 * frame / 60.0, 1.0), Eigen::Quaterniond::Identity()});
    a.step();
    b.step();
  }
  EXPECT_GT(a.position({20, 12}).y(), 0.2);
  // Same motion up to the rounding of the poses, 1e-16, grown by what contact does with it in a second: which parts
  // count as near, and whether a substep is made again, are decisions that rounding can turn.
  EXPECT_LT((a.position({20, 12}) - b.position({20, 12})).norm(), 1e-3);
}

// Where the cloth can be moves with its pins.
TEST(Obstacles, AreMetFarFromWhereTheClothBegan) {
  ObstacleParams ball = obstacleOf(ShapeKind::kSphere);
  ball.pose.position = Vec3(9.0, 0.0, 1.2);
  Simulator simulator(curtainAnd(ball));
  int touched = 0;
  std::vector<Vec3> points;
  for (int frame = 1; frame <= 300; ++frame) {
    const double way = 9.0 * std::min(1.0, frame / 240.0);
    for (int j = 0; j < 24; ++j) ASSERT_TRUE(simulator.movePin({0, j}, Vec3(way + 0.7 * j / 23.0, 0.0, 2.2)));
    simulator.step();
    simulator.copyPositions(points);
    ASSERT_LT(deepest(simulator, 0, points), 1e-3) << "frame " << frame;
    touched += simulator.statistics().contacts > 0 ? 1 : 0;
  }
  EXPECT_GT(touched, 50);
}

// Not even the last of them leaves anything behind when it goes. Velocities are held against the way of the frame: half
// a frame apart, they differ by what a node gains meanwhile, and that is less than twice the free fall's.
TEST(Obstacles, ThatHaveGoneTouchNothing) {
  ObstacleParams ball = obstacleOf(ShapeKind::kSphere);
  ball.pose.position = Vec3(0.5, -0.1, 1.5);
  Scene scene = curtainAnd(ball);
  scene.cloth.rows = scene.cloth.columns = 12;
  scene.cloth.height = 1.0;
  scene.hang.to.x() = 1.0;  // flat: gathered cloth has nodes that are faster at times
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  Simulator simulator(scene);
  for (int frame = 0; frame < 60; ++frame) simulator.step();
  ASSERT_GT(simulator.contactWrench(0).force.norm(), 0.0);
  simulator.setObstaclePresent(0, false);
  const double rate = simulator.scene().solver.frame_rate;
  std::vector<Vec3> before, after, velocity;
  for (int frame = 0; frame < 8; ++frame) {
    simulator.copyPositions(before);
    simulator.step();
    simulator.copyPositions(after);
    simulator.copyVelocities(velocity);
    EXPECT_EQ(simulator.contactWrench(0).force.norm(), 0.0);
    EXPECT_EQ(simulator.contactWrench(0).contacts, 0);
    if (frame < 4) continue;  // until what the ball held is on its way
    for (std::size_t n = 0; n < after.size(); ++n) {
      EXPECT_LT((velocity[n] - rate * (after[n] - before[n])).norm(), 9.81 / rate)
          << "frame " << frame << ", node " << n;
    }
  }
}

// leapfrog4 undoes the stages of a substep in which it meets something, and then does what auto does: from its first
// frame on it must report the same force. A free sheet falls flat on a floor 10 mm below at 1 m/s: it is 7 mm lower
// after the first stage (0.41 frames of 1/60 s), 14 mm after the second one.
TEST(Obstacles, AreNotPressedByStagesThatWereUndone) {
  Scene scene = curtain_test::flatScene(12, 12);
  scene.hang.tilt = 0.5 * curtain_test::kPi;
  scene.pins.kind = PinKind::kNone;
  ObstacleParams floor;
  floor.name = "floor";
  floor.shape = ShapeKind::kPlane;
  floor.pose.position.z() = scene.hang.from.z() - scene.contact.thickness - 0.01;
  scene.obstacles.push_back(floor);
  Simulator reference(scene);
  scene.solver.method = Method::kLeapfrog4;
  Simulator simulator(scene);
  for (Simulator* each : {&reference, &simulator}) {
    std::vector<Vec3> positions;
    each->copyPositions(positions);
    each->setState(positions, std::vector<Vec3>(positions.size(), Vec3(0.0, 0.0, -1.0)));
    each->step();
  }
  ASSERT_EQ(simulator.stateHash(), reference.stateHash());
  const Vec3 force = reference.contactWrench(0).force;
  ASSERT_LT(force.z(), 0.0);
  EXPECT_LT((simulator.contactWrench(0).force - force).norm(), 1e-12 * force.norm());
}

}  // namespace
}  // namespace curtain
