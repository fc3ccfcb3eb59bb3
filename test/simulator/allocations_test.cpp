// SPDX-License-Identifier: BSD-3-Clause
//
// The simulator allocates nothing in a step, whatever it is busy with.
#include <gtest/gtest.h>

#include <limits>

#include "count_allocations.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::run;
using curtain_test::sceneOf;
using curtain_test::shippedScene;

TEST(Allocations, NoneInAStep) {
  for (const char* name : {"curtain", "flag", "skirt", "sheet", "tied_curtain", "parachute_load"}) {
    Simulator simulator(shippedScene(name));
    DragParams pull;
    pull.id = "pull";
    pull.point = Vec3(0.3, 0.0, 1.0);
    pull.radius = 0.2;
    pull.target = Vec3(0.3, 0.4, 1.0);
    ASSERT_TRUE(simulator.setDrag(pull).empty());
    const long before = allocations;
    run(simulator, 30);
    EXPECT_EQ(allocations - before, 0) << name;
  }
}

TEST(Allocations, NoneWhileTheClothFallsAsleepAndWakesInLimitedFrames) {
  Scene scene = flatScene(12, 16);
  scene.hang.to.x() = 0.8;
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  scene.contact.self = true;
  scene.solver.budget_ms = 0.3;
  scene.solver.threads = 1;
  for (int k = 0; k < 3; ++k) {
    DragParams drag;
    drag.id = std::to_string(k);
    drag.node = NodeIndex{11, 5 * k};
    drag.force = Vec3(0.0, 0.02, 0.0);
    drag.start = 2.0 + 5.0 * k;
    drag.end = 3.0 + 5.0 * k;
    scene.drag.push_back(drag);
  }
  Simulator simulator(scene);
  run(simulator, 10);
  const long before = allocations;
  run(simulator, 1200);
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(simulator.statistics().wakes, 2);
  EXPECT_GT(simulator.statistics().asleep_frames, 100);
}

// Hands that move, slide, are torn off; what they hold bends and touches itself.
TEST(Allocations, NoneWhileHandsHoldAndLoseTheCloth) {
  Scene scene = sceneOf(16, 16);
  scene.contact.self = true;
  scene.cloth.bending_warp = scene.cloth.bending_weft = 1e-5;
  Simulator simulator(scene);
  GraspParams grasp;
  for (const char* id : {"rigid", "soft", "pads"}) {
    grasp.id = id;
    grasp.frame.position = simulator.position({14, id[0] == 'r' ? 2 : id[0] == 's' ? 7 : 12});
    grasp.radius = 0.1;
    grasp.stiffness = id[0] == 's' ? 100.0 : std::numeric_limits<double>::infinity();
    grasp.pinch_force = id[0] == 'p' ? 0.3 : std::numeric_limits<double>::infinity();
    grasp.break_force = id[0] == 'r' ? 20.0 : std::numeric_limits<double>::infinity();
    ASSERT_TRUE(simulator.setGrasp(grasp).empty()) << id;
  }
  const Vec3 from = grasp.frame.position;
  run(simulator, 2);
  long in_steps = 0;
  for (int frame = 0; frame < 60; ++frame) {
    for (const char* id : {"rigid", "soft", "pads"})
      simulator.moveGrasp(id, {from - Vec3(0.0, 0.0, 0.01 * frame), Rotation::Identity()});
    const long before = allocations;
    simulator.step();
    in_steps += allocations - before;
  }
  EXPECT_EQ(in_steps, 0);
  EXPECT_EQ(simulator.graspState("rigid")->end, GraspEnd::kBroken);
  EXPECT_GT(simulator.graspState("pads")->slipped, 0.01);
}

// Hands of the scene take hold and let go within frames.
TEST(Allocations, NoneWhileTheSceneMovesHandsAndPins) {
  Scene scene = sceneOf(12, 12);
  for (const char* id : {"rigid", "pads"}) {
    HandParams hand;
    hand.grasp.id = id;
    hand.grasp.frame.position = Simulator(scene).position({11, id[0] == 'r' ? 2 : 9});
    hand.grasp.radius = 0.15;
    if (id[0] == 'p') hand.grasp.pinch_force = 0.3;
    hand.start = 0.2;
    hand.end = 0.7;
    hand.motion = {{0.2, hand.grasp.frame}, {1.0, {hand.grasp.frame.position + Vec3(0.0, 0.3, -0.2), {}}}};
    hand.motion[1].pose.orientation = Rotation::Identity();
    scene.hands.push_back(hand);
  }
  scene.pins_motion = {{0.0, Pose()}, {1.0, {Vec3(0.0, 0.1, 0.1), Rotation::Identity()}}};
  Simulator simulator(scene);
  const long before = allocations;
  run(simulator, 60);
  EXPECT_EQ(allocations - before, 0);
  EXPECT_EQ(simulator.graspState("rigid")->end, GraspEnd::kReleased);
  EXPECT_NE(simulator.graspState("pads")->end, GraspEnd::kMissed);
}

// Its iterates are kept with the contacts that they were found with.
TEST(Allocations, NoneInTheLastResort) {
  Scene scene = sceneOf(12, 10);
  scene.contact.self = true;
  ObstacleParams ball;
  ball.name = "ball";
  ball.radius = 0.1;
  const Vec3 middle = 0.5 * (scene.hang.from + scene.hang.to) - Vec3(0.0, 0.0, 0.5 * scene.cloth.height);
  ball.motion = {{0.0, {middle - Vec3(0.0, 1.0, 0.0), Eigen::Quaterniond::Identity()}},
                 {0.05, {middle + Vec3(0.0, 1.0, 0.0), Eigen::Quaterniond::Identity()}}};
  ball.pose = ball.motion[0].pose;
  scene.obstacles.push_back(ball);
  DragParams pull;
  pull.id = "pull";
  pull.node = NodeIndex{11, 4};
  pull.force = Vec3(0.0, 1e6, 0.0);
  scene.drag.push_back(pull);
  Simulator simulator(scene);
  const long before = allocations;
  for (int frame = 0; frame < 30; ++frame) simulator.step();
  EXPECT_EQ(allocations - before, 0);
  EXPECT_GT(simulator.statistics().last_resort_substeps, 0);
  EXPECT_GT(simulator.statistics().contacts_max, 0);
}

// Of the mesh that the eye sees, near an obstacle, once it was made there.
TEST(Allocations, NoneForAFineMesh) {
  ObstacleParams obstacle;
  obstacle.name = "obstacle";
  obstacle.pose.position = Vec3(0.5, 0.0, 1.2);
  for (const ShapeKind shape : {ShapeKind::kBox, ShapeKind::kMesh}) {
    Scene scene = sceneOf(20, 15);
    obstacle.shape = shape;
    obstacle.size = Vec3(0.3, 0.3, 0.3);
    obstacle.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/icosphere.stl";
    if (shape == ShapeKind::kMesh) obstacle.scale = Vec3::Constant(0.2);
    scene.obstacles.push_back(obstacle);
    Simulator simulator(scene);
    run(simulator, 10);
    FineMesh mesh;
    simulator.copyFineMesh(mesh);
    const long before = allocations;
    simulator.copyFineMesh(mesh);
    EXPECT_EQ(allocations - before, 0);
  }
}

}  // namespace
}  // namespace curtain
