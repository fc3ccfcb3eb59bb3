// SPDX-License-Identifier: BSD-3-Clause
//
// Obstacles and cloth never go through each other: fast ones, thin ones, ones smaller than a face, ones that appear
// inside it. The judge is the brute-force count of piercings; wrenches are judged by weights.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "curtain_sim/simulator.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kPi;
using curtain_test::massOf;

Scene hangingCurtain(int rows, int columns) {
  Scene scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  scene.cloth.height = 2.0;
  scene.cloth.width = 1.0;
  scene.air.inside = scene.air.border = scene.air.corner = 0.1;
  return scene;
}

ObstacleParams ballOf(double radius) {
  ObstacleParams ball;
  ball.name = "ball";
  ball.shape = ShapeKind::kSphere;
  ball.radius = radius;
  return ball;
}

ObstacleParams boxOf(const Vec3& size) {
  ObstacleParams box;
  box.name = "box";
  box.shape = ShapeKind::kBox;
  box.size = size;
  return box;
}

double stretchOf(const Simulator& simulator) {
  const Statistics& s = simulator.statistics();
  return std::max({s.warp_stretch, s.weft_stretch, s.warp_compression});
}

int piercingsOf(const Simulator& simulator, int obstacle) {
  const Piercings count = simulator.piercings(obstacle);
  return count.nodes + count.edges + count.faces;
}

struct Shot {
  const char* name;
  double speed;  // [m/s]
};

class Impact : public ::testing::TestWithParam<Shot> {};

// From half a metre before the curtain to a metre and a half behind it.
TEST_P(Impact, GoesThroughNothingAndKeepsTheLinks) {
  const std::string name = GetParam().name;
  const double speed = GetParam().speed;
  const bool small = name == "marble";
  Scene scene = small ? hangingCurtain(12, 8) : hangingCurtain(44, 40);
  ObstacleParams shot = name == "ball" ? ballOf(0.3) : small ? ballOf(0.01) : boxOf(Vec3(0.6, 0.6, 0.002));
  const Eigen::Quaterniond broadside(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()));
  const Eigen::Quaterniond turned = name == "broadside" ? broadside : Eigen::Quaterniond::Identity();
  const Vec3 aim = small ? Vec3(0.53, 0.0, 1.23) : Vec3(0.5, 0.0, 1.2);
  const double duration = 2.0 / speed;
  shot.motion = {{0.0, {aim - Vec3(0.0, 0.5, 0.0), turned}}, {duration, {aim + Vec3(0.0, 1.5, 0.0), turned}}};
  scene.obstacles.push_back(shot);
  const double tolerance = scene.solver.stretch_tolerance;
  Simulator simulator(scene);
  double during = 0.0, after = 0.0;
  int pierced = 0;
  while (simulator.time() < duration + 0.4) {
    simulator.step();
    pierced = std::max(pierced, piercingsOf(simulator, 0));
    double& worst = simulator.time() < duration + 0.2 ? during : after;
    worst = std::max(worst, stretchOf(simulator));
  }
  const Statistics& s = simulator.statistics();
  std::printf("%s at %g m/s: stretch %.1e during, %.1e after, %d stops, obstacle waited %.2g s\n", name.c_str(), speed,
              during, after, static_cast<int>(s.stops), s.obstacles_waited);
  EXPECT_TRUE(simulator.statistics().finite);
  EXPECT_EQ(pierced, 0);
  EXPECT_LE(during, tolerance);
  EXPECT_LE(after, tolerance);
  EXPECT_GT(simulator.statistics().contacts_max, 0);
}

INSTANTIATE_TEST_SUITE_P(Shots, Impact,
                         ::testing::Values(Shot{"ball", 1.0}, Shot{"ball", 5.0}, Shot{"ball", 20.0}, Shot{"ball", 50.0},
                                           Shot{"broadside", 1.0}, Shot{"broadside", 5.0}, Shot{"broadside", 20.0},
                                           Shot{"broadside", 50.0}, Shot{"edge_on", 1.0}, Shot{"edge_on", 5.0},
                                           Shot{"edge_on", 20.0}, Shot{"edge_on", 50.0}, Shot{"marble", 1.0},
                                           Shot{"marble", 5.0}, Shot{"marble", 20.0}, Shot{"marble", 50.0}));

Scene fallingSheet(int rows, int columns, double side, double height) {
  Scene scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  scene.cloth.height = scene.cloth.width = side;
  scene.hang.from = Vec3(-0.5 * side, 0.5 * side, height);
  scene.hang.to = Vec3(0.5 * side, 0.5 * side, height);
  scene.hang.tilt = 0.5 * kPi;
  scene.pins.kind = PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 0.5;
  return scene;
}

Vec3 centreOf(const Simulator& simulator) {
  Vec3 sum = Vec3::Zero();
  double mass = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) {
      sum += simulator.mass({i, j}) * simulator.position({i, j});
      mass += simulator.mass({i, j});
    }
  }
  return sum / mass;
}

// At rest a sheet presses on what it lies on with its weight, at its centre of mass.
TEST(ContactWrench, ASheetAtRestPressesWithItsWeight) {
  for (const bool plane : {true, false}) {
    ObstacleParams floor = boxOf(Vec3(2.0, 2.0, 0.2));
    if (plane) floor.shape = ShapeKind::kPlane;
    floor.pose.position = Vec3(0.1, 0.2, plane ? 0.0 : -0.1);
    Scene scene = fallingSheet(12, 10, 0.6, 0.02);
    scene.obstacles.push_back(floor);
    Simulator simulator(scene);
    for (int frame = 0; frame < 180; ++frame) simulator.step();
    const double weight = 9.81 * massOf(simulator);
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (int frame = 0; frame < 30; ++frame) {
      simulator.step();
      force += simulator.contactWrench(0).force / 30.0;
      torque += simulator.contactWrench(0).torque / 30.0;
    }
    EXPECT_NEAR(force.z(), -weight, 1e-3 * weight) << plane;
    EXPECT_LT(std::hypot(force.x(), force.y()), 1e-3 * weight) << plane;
    const Vec3 arm = centreOf(simulator) - floor.pose.position;
    EXPECT_NEAR(torque.x(), -weight * arm.y(), 1e-3 * weight) << plane;
    EXPECT_NEAR(torque.y(), weight * arm.x(), 1e-3 * weight) << plane;
    EXPECT_GT(simulator.contactWrench(0).contacts, 0);
  }
}

// Links of 5 cm over a box: no edge or corner of it comes through, on the way down or at rest.
TEST(Obstacles, NoCornerComesThroughADrapedSheet) {
  for (const bool mesh : {false, true}) {
    ObstacleParams box = boxOf(Vec3(0.4, 0.4, 0.4));
    if (mesh) {
      box.shape = ShapeKind::kMesh;
      box.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/cube_binary.stl";
    }
    Scene scene = fallingSheet(21, 21, 1.0, 1.0);
    scene.obstacles.push_back(box);
    Simulator probe(scene);
    const double top = probe.obstacleShape(0).bounds().max().z();
    scene.obstacles[0].scale *= mesh ? 0.2 / top : 1.0;
    scene.hang.from.z() = scene.hang.to.z() = 0.25;
    Simulator simulator(scene);
    int pierced = 0;
    for (int frame = 0; frame < 120; ++frame) {
      simulator.step();
      pierced = std::max(pierced, piercingsOf(simulator, 0));
    }
    EXPECT_EQ(pierced, 0) << mesh;
    EXPECT_LE(stretchOf(simulator), scene.solver.stretch_tolerance) << mesh;
    EXPECT_TRUE(simulator.statistics().finite);
  }
}

// What appears inside the cloth lets it out within two seconds, and nothing is pierced from then on.
TEST(Obstacles, WhatAppearsInTheClothLetsItGo) {
  for (const char* name : {"ball", "box", "mesh"}) {
    Scene scene = hangingCurtain(30, 24);
    ObstacleParams obstacle = std::string(name) == "ball" ? ballOf(0.2) : boxOf(Vec3(0.4, 0.3, 0.5));
    if (std::string(name) == "mesh") {
      obstacle.shape = ShapeKind::kMesh;
      obstacle.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/icosphere.stl";
      obstacle.scale = Vec3::Constant(0.2);
    }
    obstacle.pose.position = Vec3(0.5, 0.05, 1.0);
    scene.obstacles.push_back(obstacle);
    Simulator simulator(scene);
    int pierced = 0;
    for (int frame = 0; frame < 180; ++frame) {
      simulator.step();
      if (frame >= 120) pierced = std::max(pierced, piercingsOf(simulator, 0));
    }
    EXPECT_EQ(pierced, 0) << name;
    EXPECT_LE(stretchOf(simulator), scene.solver.stretch_tolerance) << name;
    EXPECT_TRUE(simulator.statistics().finite) << name;
  }
}

// A bar that turns ten times a second in front of the curtain and comes nearer.
TEST(Obstacles, ASpinningBarGoesThroughNothing) {
  Scene scene = hangingCurtain(30, 24);
  ObstacleParams bar = boxOf(Vec3(0.5, 0.05, 0.05));
  for (int k = 0; k <= 40; ++k) {
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.5 * kPi * k, Vec3::UnitY()));
    bar.motion.push_back({0.025 * k, {Vec3(0.5, -0.2 + 0.01 * k, 1.0), turned}});
  }
  scene.obstacles.push_back(bar);
  Simulator simulator(scene);
  int pierced = 0;
  for (int frame = 0; frame < 90; ++frame) {
    simulator.step();
    pierced = std::max(pierced, piercingsOf(simulator, 0));
  }
  EXPECT_EQ(pierced, 0);
  EXPECT_LE(stretchOf(simulator), scene.solver.stretch_tolerance);
  EXPECT_TRUE(simulator.statistics().finite);
}

// Two balls and a box in a curtain that also touches itself: they jump through it, vanish and come back inside it.
TEST(Obstacles, SeveralThatJumpAndVanishLeaveTheClothWhole) {
  Scene scene = hangingCurtain(24, 20);
  scene.air.inside = scene.air.border = scene.air.corner = 0.5;
  scene.contact.self = true;
  scene.obstacles = {ballOf(0.2), ballOf(0.15), boxOf(Vec3(0.3, 0.3, 0.3))};
  scene.obstacles[1].name = "second";
  const std::vector<Vec3> places = {Vec3(0.3, -0.4, 1.2), Vec3(0.7, 0.4, 0.9), Vec3(0.5, -0.6, 0.6)};
  for (std::size_t n = 0; n < places.size(); ++n) scene.obstacles[n].pose.position = places[n];
  Simulator simulator(scene);
  const auto steps = [&](int count) {
    for (int frame = 0; frame < count; ++frame) simulator.step();
  };
  steps(10);
  for (int n = 0; n < 3; ++n) {
    Pose there;
    there.position = places[static_cast<std::size_t>(n)];
    there.position.y() = -there.position.y();
    simulator.setObstaclePose(n, there, true);  // through the curtain at once
    steps(20);
  }
  simulator.setObstaclePresent(0, false);
  steps(10);
  Pose inside;
  inside.position = {0.5, 0.02, 1.1};
  simulator.setObstaclePose(0, inside, true);
  simulator.setObstaclePresent(0, true);
  steps(120);
  EXPECT_TRUE(simulator.statistics().finite);
  EXPECT_LE(stretchOf(simulator), scene.solver.stretch_tolerance);
  EXPECT_EQ(simulator.selfCrossings(), 0);
  for (int n = 0; n < 3; ++n) EXPECT_EQ(piercingsOf(simulator, n), 0) << "obstacle " << n;
  EXPECT_GT(simulator.statistics().contacts_max, 20);
}

}  // namespace
}  // namespace curtain
