// SPDX-License-Identifier: BSD-3-Clause
//
// Threads change the time a frame takes and nothing else: the motion is the same to the bit for every number of them.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain {
namespace {

WindParams gustyFan(const Vec3& position) {
  WindParams wind;
  wind.id = "fan";
  wind.position = position;
  wind.direction = Vec3(0.1, 1.0, 0.1);
  wind.radius = 2.0;
  wind.half_angle = 0.2;
  wind.pressure = 15.0;
  wind.unsteadiness = 5.0;
  return wind;
}

// 44 x 40 nodes, gathered on 0.6 of their width, in a gusty wind.
Scene gatheredCurtain() {
  Scene scene = curtain_test::flatScene(44, 40, 2.0);
  scene.hang.to.x() = 0.6;
  scene.air.inside = scene.air.border = scene.air.corner = 0.2;
  scene.wind.push_back(gustyFan(Vec3(0.3, -1.5, 1.0)));
  return scene;
}

// 60 x 50 nodes, dropped from near the horizontal: every string of it gets taut, and sums go over all rows.
Scene sheetOnTwoCorners() {
  Scene scene = curtain_test::flatScene(60, 50);
  scene.hang.to.x() = 0.9;
  scene.hang.tilt = 1.2;
  scene.pins.kind = PinKind::kTopCorners;
  return scene;
}

// 40 x 47 nodes: rows that close, and columns that end within a block.
Scene skirt() {
  Scene scene = curtain_test::ringScene(40, 47, 0.8, 1.2);
  scene.cloth.hem_width = 2.0;
  scene.hang.tilt = 0.1;
  scene.air.inside = scene.air.border = scene.air.corner = 0.2;
  scene.wind.push_back(gustyFan(Vec3(0.0, -1.5, 1.6)));
  return scene;
}

// 44 x 40 nodes that touch themselves, a ball and a mesh, on which they are blown.
Scene curtainInContact() {
  Scene scene = gatheredCurtain();
  scene.contact.self = true;
  ObstacleParams ball = curtain_test::ballAt({0.2, 0.35, 1.5}, 0.2);
  ObstacleParams body = ball;
  body.name = "body";
  body.shape = ShapeKind::kMesh;
  body.mesh = CURTAIN_SOURCE_DIR "/test/meshes/icosphere.stl";
  body.scale = Vec3::Constant(0.2);
  body.pose.position = Vec3(0.4, 0.4, 1.0);
  scene.obstacles = {ball, body};
  return scene;
}

struct Case {
  const char* name;
  Scene (*scene)();
};

class ThreadCount : public ::testing::TestWithParam<Case> {};

// 0 is auto. Equal hashes are equal bits of positions and velocities; equal counts of sweeps, the same way there.
TEST_P(ThreadCount, DoesNotChangeABit) {
  std::uint64_t hash = 0;
  std::int64_t sweeps = 0;
  for (const int threads : {1, 2, 3, 4, 0}) {
    Scene scene = GetParam().scene();
    scene.solver.threads = threads;
    Simulator simulator(scene);
    const std::uint64_t start = simulator.stateHash();
    for (int frame = 0; frame < 30; ++frame) simulator.step();
    const Statistics& s = simulator.statistics();
    EXPECT_TRUE(s.finite);
    EXPECT_GT(s.sweeps, s.substeps) << "no string is taut: nothing is shared out";
    EXPECT_NE(simulator.stateHash(), start);
    for (int n = 0; n < simulator.obstacleCount(); ++n) EXPECT_GT(simulator.contactWrench(n).contacts, 0) << n;
    if (threads == 1) {
      hash = simulator.stateHash();
      sweeps = s.sweeps;
    }
    EXPECT_EQ(simulator.stateHash(), hash) << threads << " threads";
    EXPECT_EQ(s.sweeps, sweeps) << threads << " threads";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ThreadCount,
                         ::testing::Values(Case{"GatheredCurtain", gatheredCurtain},
                                           Case{"SheetOnTwoCorners", sheetOnTwoCorners}, Case{"Skirt", skirt},
                                           Case{"CurtainInContact", curtainInContact}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace curtain
