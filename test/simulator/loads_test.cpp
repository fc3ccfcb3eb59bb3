// SPDX-License-Identifier: BSD-3-Clause
//
// What viewers are told beside positions: tensions of the links, the contacts' part of the forces, rest lengths, and a
// fine mesh that is built from these alone.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "curtain_sim/simulator.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kGravity;
using curtain_test::ringScene;

Scene hanging(double rest_speed) {
  Scene scene = flatScene(12, 6);
  scene.air.inside = scene.air.border = scene.air.corner = 2.0;
  scene.solver.rest_speed = rest_speed;
  return scene;
}

// At rest every rod bears the weight below it. Rods move on within the stretch tolerance (1e-3), and what the damping
// has left after 20 s is less than that.
void expectWeightBelow(const Simulator& simulator) {
  std::vector<double> warp, weft;
  simulator.copyTensions(warp, weft);
  const int rows = simulator.rows(), columns = simulator.columns();
  ASSERT_EQ(warp.size(), static_cast<std::size_t>(rows * columns));
  ASSERT_EQ(weft.size(), warp.size());
  for (int j = 0; j < columns; ++j) {
    double weight = 0.0;
    for (int i = rows - 1; i > 0; --i) {
      weight += kGravity * simulator.mass({i, j});
      EXPECT_NEAR(warp[static_cast<std::size_t>(i * columns + j)], weight, 1e-3 * weight) << i << ", " << j;
    }
    EXPECT_EQ(warp[static_cast<std::size_t>(j)], 0.0) << "there is no rod above the hung edge";
  }
}

TEST(Loads, RodsOfAHangingClothBearTheWeightBelowAsleepOrAwake) {
  for (const double rest_speed : {0.0, 0.002}) {
    Simulator simulator(hanging(rest_speed));
    std::vector<double> warp, weft;
    simulator.copyTensions(warp, weft);
    for (const double tension : warp) EXPECT_EQ(tension, 0.0) << "there was no step yet";
    for (int frame = 0; frame < 1200; ++frame) simulator.step();
    EXPECT_EQ(simulator.statistics().asleep, rest_speed > 0.0);
    expectWeightBelow(simulator);
  }
}

// Between its corners the cloth hangs from its rows.
TEST(Loads, WeftLinksOnlyPull) {
  Scene scene = flatScene(10, 8);
  scene.hang.to.x() = 0.8;
  scene.pins.kind = PinKind::kTopCorners;
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  Simulator simulator(scene);
  for (int frame = 0; frame < 600; ++frame) simulator.step();
  std::vector<double> warp, weft;
  simulator.copyTensions(warp, weft);
  double most = 0.0;
  for (const double tension : weft) {
    EXPECT_GE(tension, 0.0);
    most = std::max(most, tension);
  }
  // The corners bear the weight, and the top row between them at least what keeps its slope.
  EXPECT_GT(most, 0.1 * 0.2 * kGravity);
}

TEST(Loads, ContactForcesOfAHangingClothAreZeroAndOfALyingOneBearIt) {
  Scene scene = flatScene(10, 10, 0.5, 0.5);
  scene.pins.kind = PinKind::kNone;
  scene.hang.tilt = 0.5 * curtain_test::kPi;
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  ObstacleParams floor;
  floor.name = "floor";
  floor.shape = ShapeKind::kPlane;
  scene.obstacles.push_back(floor);
  Simulator simulator(scene);
  std::vector<Vec3> forces;
  simulator.step();
  simulator.copyContactForces(forces);
  ASSERT_EQ(forces.size(), 100u);
  for (const Vec3& force : forces) EXPECT_EQ(force, Vec3::Zero()) << "it still falls";
  for (int frame = 0; frame < 600; ++frame) simulator.step();
  simulator.copyContactForces(forces);
  const Vec3 sum = std::accumulate(forces.begin(), forces.end(), Vec3(Vec3::Zero()));
  const double weight = kGravity * 0.2 * 0.25;
  EXPECT_NEAR(sum.z(), weight, 1e-2 * weight);
  EXPECT_LT(std::hypot(sum.x(), sum.y()), 1e-2 * weight);
}

TEST(Loads, RestLengthsAreTheClothsAndGiveItsFineMesh) {
  for (const bool closed : {false, true}) {
    Scene scene = closed ? ringScene(7, 9) : flatScene(7, 9);
    scene.cloth.hem_width = 1.3;
    scene.hang.to.x() = 0.7;
    WindParams wind;
    wind.id = "fan";
    wind.position = Vec3(0.3, -1.0, 1.0);
    wind.radius = 1.0;
    wind.pressure = 3.0;
    scene.wind.push_back(wind);
    Simulator simulator(scene);
    for (int frame = 0; frame < 40; ++frame) simulator.step();
    std::vector<double> warp, weft;
    simulator.copyRestLengths(warp, weft);
    ASSERT_EQ(warp.size(), 6u);
    EXPECT_NEAR(std::accumulate(warp.begin(), warp.end(), 0.0), scene.cloth.height, 1e-12);
    const std::size_t links = closed ? 9 : 8;
    ASSERT_EQ(weft.size(), 7 * links);
    const auto width = [&](std::size_t row) {
      const auto first = weft.begin() + static_cast<std::ptrdiff_t>(row * links);
      return std::accumulate(first, first + static_cast<std::ptrdiff_t>(links), 0.0);
    };
    EXPECT_NEAR(width(0), scene.cloth.width, 1e-12);
    EXPECT_NEAR(width(6), 1.3, 1e-12);

    std::vector<Vec3> nodes;
    simulator.copyPositions(nodes);
    FineMesh mesh, expected;
    FineMeshBuilder(simulator.scene().cloth, weft).build(nodes, mesh);
    simulator.copyFineMesh(expected);
    EXPECT_TRUE(mesh.positions == expected.positions) << "the same bits, where no obstacle is near";
  }
}

}  // namespace
}  // namespace curtain
