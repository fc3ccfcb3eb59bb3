// SPDX-License-Identifier: BSD-3-Clause
//
// What obstacles feel of the cloth: its weight at rest, its momentum when it hits them, and where it presses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "curtain_sim/simulator.h"
#include "figures.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kGravity;
using curtain_test::kPi;

// A horizontal sheet of 12 x 10 nodes over the origin.
Scene sheetAt(double height, double air) {
  Scene scene;
  scene.cloth.rows = 12;
  scene.cloth.columns = 10;
  scene.cloth.height = scene.cloth.width = 0.6;
  scene.hang.from = Vec3(-0.3, 0.3, height);
  scene.hang.to = Vec3(0.3, 0.3, height);
  scene.hang.tilt = 0.5 * kPi;
  scene.pins.kind = PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = air;
  return scene;
}

ObstacleParams boxOf(const Vec3& size, const Vec3& position, const std::string& name = "box") {
  ObstacleParams box;
  box.name = name;
  box.shape = ShapeKind::kBox;
  box.size = size;
  box.pose.position = position;
  return box;
}

Vec3 momentumOf(const Simulator& simulator, double& mass) {
  std::vector<Vec3> velocities;
  simulator.copyVelocities(velocities);
  Vec3 sum = Vec3::Zero();
  mass = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) {
      const double m = simulator.mass({i, j});
      sum += m * velocities[static_cast<std::size_t>(i * simulator.columns() + j)];
      mass += m;
    }
  }
  return sum;
}

Vec3 sumOf(const std::vector<ContactForce>& points, int obstacle) {
  Vec3 sum = Vec3::Zero();
  for (const ContactForce& point : points) {
    if (point.obstacle == obstacle) sum += point.friction - point.normal_force * point.normal;
  }
  return sum;
}

struct Blow {
  const char* name;
  Vec3 velocity;  // of the box [m/s]
  double spin;    // of the box about z [rad/s]
  Method method = Method::kAuto;
};

class Blows : public ::testing::TestWithParam<Blow> {};

// Cloth in free fall is hit by a box that goes on, and leaves it after a while: what the wrenches add up to is the
// momentum that the cloth has given up, beside gravity's. At the end it flies again: velocities at a frame's end are
// those of half a substep before, extrapolated, and that is exact where nothing but gravity pushes.
TEST_P(Blows, TakeTheMomentumThatTheClothGivesUp) {
  const Blow& blow = GetParam();
  Scene scene = sheetAt(1.0, 0.0);
  scene.solver.method = blow.method;
  const double leaves = 0.7, duration = 1.0;
  ObstacleParams box = boxOf(Vec3(0.5, 0.5, 0.1), Vec3(0.05, 0.02, 0.6));
  for (int k = 0; k <= 7; ++k) {
    PoseKey key;
    key.time = k * leaves / 7.0;
    key.pose.position = box.pose.position + key.time * blow.velocity;
    key.pose.orientation = Eigen::AngleAxisd(blow.spin * key.time, Vec3::UnitZ());
    box.motion.push_back(key);
  }
  box.motion.push_back(box.motion.back());
  box.motion.back().time = duration;
  box.motion.back().pose.position.z() -= 5.0;
  scene.obstacles.push_back(box);
  Simulator simulator(scene);
  double mass = 0.0, felt = 0.0;
  const Vec3 start = momentumOf(simulator, mass);
  Vec3 impulse = Vec3::Zero();
  while (simulator.time() < duration) {
    simulator.step();
    const ContactWrench wrench = simulator.contactWrench(0);
    impulse += wrench.time * wrench.force;
    felt += wrench.time * wrench.force.norm();
  }
  EXPECT_EQ(simulator.contactWrench(0).contacts, 0) << "it flies";
  const Vec3 by_gravity = simulator.time() * mass * scene.gravity;
  const Vec3 given_up = start + by_gravity - momentumOf(simulator, mass);
  std::printf("%s: impulse %.4f N s, given up %.4f N s, off by %.1e of what was felt; %d stops\n", blow.name,
              impulse.norm(), given_up.norm(), (impulse - given_up).norm() / felt,
              static_cast<int>(simulator.statistics().stops));
  curtain_test::keepFigure(std::string("blow ") + blow.name + ", off by", (impulse - given_up).norm() / felt);
  EXPECT_GT(felt, 0.1 * mass) << "it was hit";
  EXPECT_LT((impulse - given_up).norm(), 1e-3 * felt);
}

INSTANTIATE_TEST_SUITE_P(ContactWrench, Blows,
                         ::testing::Values(Blow{"from below", Vec3(0.0, 0.0, 1.0), 0.0},
                                           Blow{"aslant", Vec3(0.8, 0.3, 0.5), 0.0},
                                           Blow{"spinning", Vec3(0.0, 0.0, 0.3), 3.0},
                                           Blow{"leapfrog4", Vec3(0.8, 0.3, 0.5), 2.0, Method::kLeapfrog4},
                                           Blow{"implicit", Vec3(0.8, 0.3, 0.5), 2.0, Method::kImplicit}));

// The places where a sheet at rest presses: their forces add up to its weight and to the wrench, each pushes out of its
// obstacle, and friction is within Coulomb's bound.
TEST(ContactPoints, AddUpToTheWeight) {
  Scene scene = sheetAt(0.02, 0.5);
  scene.obstacles = {boxOf(Vec3(0.4, 2.0, 0.2), Vec3(-0.2, 0.0, -0.1), "left"),
                     boxOf(Vec3(0.4, 2.0, 0.2), Vec3(0.2, 0.0, -0.1), "right")};
  Simulator simulator(scene);
  std::vector<ContactForce> points(3);
  simulator.copyContactPoints(points);
  EXPECT_TRUE(points.empty()) << "before the first step";
  for (int frame = 0; frame < 240; ++frame) simulator.step();
  simulator.copyContactPoints(points);
  double mass = 0.0;
  momentumOf(simulator, mass);
  const double weight = kGravity * mass;
  EXPECT_NEAR((sumOf(points, 0) + sumOf(points, 1)).z(), -weight, 1e-3 * weight);
  for (int side = 0; side < 2; ++side) {
    const ContactWrench wrench = simulator.contactWrench(side);
    EXPECT_LT((sumOf(points, side) - wrench.force).norm(), 1e-3 * weight) << side;
    const auto count = std::count_if(points.begin(), points.end(), [&](const auto& p) { return p.obstacle == side; });
    EXPECT_EQ(count, wrench.contacts);
    EXPECT_GT(count, 10);
  }
  for (const ContactForce& point : points) {
    EXPECT_GT(point.normal_force, 0.0);
    EXPECT_NEAR(point.normal.z(), 1.0, 1e-12);
    EXPECT_NEAR(point.position.z(), scene.contact.thickness, 0.1 * scene.contact.thickness);
    EXPECT_NEAR(point.friction.dot(point.normal), 0.0, 1e-9 * weight);
    EXPECT_LE(point.friction.norm(), (1.0 + 1e-9) * scene.contact.friction * point.normal_force);
  }
  simulator.setObstaclePresent(0, false);
  simulator.setObstaclePresent(1, false);
  simulator.step();
  simulator.copyContactPoints(points);
  EXPECT_TRUE(points.empty()) << "they are gone";
}

}  // namespace
}  // namespace curtain
