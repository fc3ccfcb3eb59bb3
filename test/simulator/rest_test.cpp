// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that lies on something: comes to rest and stays, never gains energy, and slips where Coulomb says.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <vector>

#include "curtain_sim/simulator.h"
#include "figures.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::ballAt;
using curtain_test::flatScene;
using curtain_test::kPi;

double rmsSpeed(const Simulator& simulator) {
  std::vector<Vec3> velocity;
  simulator.copyVelocities(velocity);
  double sum = 0.0;
  for (const Vec3& v : velocity) sum += v.squaredNorm();
  return std::sqrt(sum / static_cast<double>(velocity.size()));
}

// A horizontal sheet of 1 m x 1 m above the origin, in air that damps what swings within a second.
Scene sheetAbove(double height, const ObstacleParams& obstacle) {
  Scene scene = flatScene(24, 24);
  scene.hang.from = {-0.5, 0.5, height};
  scene.hang.to = {0.5, 0.5, height};
  scene.hang.tilt = 0.5 * kPi;
  scene.pins.kind = PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 2.0;
  scene.contact.self = true;
  scene.solver.rest_speed = 0.0;  // what the solver leaves is what is looked at
  scene.obstacles.push_back(obstacle);
  return scene;
}

void expectRest(const char* name, const Scene& scene, double allowed) {
  Simulator simulator(scene);
  const Energy start = simulator.energy();
  double last = start.kinetic + start.potential;
  // What the solve leaves of the links' lengths is up to a tolerance's share of a link's potential.
  const double size = scene.cloth.surface_density * scene.gravity.norm() * scene.cloth.height * scene.cloth.width *
                      scene.solver.stretch_tolerance * scene.cloth.height;
  double rise = 0.0, speed = 0.0;
  for (int frame = 1; frame <= 300; ++frame) {
    simulator.step();
    const Energy energy = simulator.energy();
    rise = std::max(rise, energy.kinetic + energy.potential - last);
    last = std::min(last, energy.kinetic + energy.potential);
    if (frame > 180) speed = std::max(speed, rmsSpeed(simulator));
  }
  std::printf("%s: at most %.2f mm/s after 3 s, energy rises by at most %.1e J (of %.1e)\n", name, 1e3 * speed, rise,
              size);
  curtain_test::keepFigure(std::string("at rest on a ") + name + ", speed [mm/s]", 1e3 * speed);
  EXPECT_LT(speed, allowed);
  EXPECT_LE(rise, size);
  EXPECT_GT(simulator.statistics().contacts, 100);
}

TEST(Rest, ComesOnASphere) {
  ObstacleParams ball = ballAt({0.0, 0.0, 0.3}, 0.3);
  ball.friction = 0.3;
  expectRest("sphere", sheetAbove(0.65, ball), 1e-3);
}

ObstacleParams table(double width) {
  ObstacleParams table;
  table.name = "table";
  table.shape = ShapeKind::kBox;
  table.size = {width, width, 0.5};
  table.pose.position = {0.0, 0.0, 0.25};
  table.friction = 0.3;
  return table;
}

TEST(Rest, ComesOnATable) { expectRest("table", sheetAbove(0.55, table(1.2)), 1e-3); }

// With its border hanging over the edges, pulled taut across four corners.
TEST(Rest, ComesOnATableThatIsSmaller) { expectRest("smaller table", sheetAbove(0.55, table(0.6)), 2e-3); }

TEST(Rest, ComesOnTheFloor) {
  ObstacleParams floor;
  floor.name = "floor";
  floor.shape = ShapeKind::kPlane;
  expectRest("floor", sheetAbove(0.05, floor), 1e-3);
}

// Limp sheets that hang over something, with folds that touch each other. The one on the plate trembled where links did
// not give (kWeftCompliance); the others did where friction of the cloth with itself lagged behind its pushes.
TEST(Rest, ComesToDrapes) {
  struct Drape {
    int nodes;
    double width;  // of the sheet [m]
    Vec3 centre;   // where it begins [m]
    double friction;
    ObstacleParams obstacle;
  };
  ObstacleParams post, ball, plate;
  post.shape = ShapeKind::kCylinder;
  post.radius = 0.173;
  post.length = 0.464;
  ball.shape = ShapeKind::kSphere;
  ball.radius = 0.116;
  plate.shape = ShapeKind::kBox;
  plate.size = {0.04, 0.471, 0.3};
  for (const Drape& drape :
       {Drape{10, 0.753, {0.0397, 0.0238, 0.8464}, 0.8, post}, Drape{20, 0.675, {-0.0272, 0.0282, 0.6421}, 0.3, ball},
        Drape{20, 0.704, {0.0273, -0.0012, 0.6721}, 0.8, plate}}) {
    Scene scene = flatScene(drape.nodes, drape.nodes, drape.width, drape.width);
    const double half = 0.5 * drape.width;
    scene.hang.from = drape.centre + Vec3(-half, half, 0.0);
    scene.hang.to = drape.centre + Vec3(half, half, 0.0);
    scene.hang.tilt = 0.5 * kPi;
    scene.pins.kind = PinKind::kNone;
    scene.cloth.surface_density = 0.2;
    scene.air.inside = scene.air.border = scene.air.corner = 1.0;
    scene.contact.self = true;
    scene.obstacles.push_back(drape.obstacle);
    scene.obstacles.back().name = "obstacle";
    scene.obstacles.back().friction = drape.friction;
    scene.obstacles.back().pose.position = {0.0, 0.0, 0.5};
    Simulator simulator(scene);
    int frames = 0;
    while (!simulator.statistics().asleep && frames < 600) {
      simulator.step();
      ++frames;
    }
    EXPECT_TRUE(simulator.statistics().asleep) << drape.width;
    EXPECT_GT(simulator.statistics().contacts, 0);
  }
}

// A sheet on a slope, released at rest: how it has moved on average, half a second after it had time to settle.
struct Slope {
  double moved = 0.0;         // down the slope [m]
  double acceleration = 0.0;  // [m/s^2]
};

Slope onASlope(double friction, double angle) {
  Scene scene = flatScene(16, 16, 0.5, 0.5);
  scene.hang.from = {-0.25, 0.25, 0.0041};
  scene.hang.to = {0.25, 0.25, 0.0041};
  scene.hang.tilt = 0.5 * kPi;
  scene.pins.kind = PinKind::kNone;
  scene.contact.self = true;
  scene.gravity = 9.81 * Vec3(std::sin(angle), 0.0, -std::cos(angle));
  ObstacleParams floor;
  floor.name = "floor";
  floor.shape = ShapeKind::kPlane;
  floor.friction = friction;
  scene.obstacles.push_back(floor);
  Simulator simulator(scene);
  const auto mean = [&](bool velocities) {
    std::vector<Vec3> values;
    if (velocities)
      simulator.copyVelocities(values);
    else
      simulator.copyPositions(values);
    double sum = 0.0;
    for (const Vec3& value : values) sum += value.x();
    return sum / static_cast<double>(values.size());
  };
  for (int frame = 0; frame < 30; ++frame) simulator.step();
  const double place = mean(false), speed = mean(true);
  for (int frame = 0; frame < 30; ++frame) simulator.step();
  return {mean(false) - place, (mean(true) - speed) / 0.5};
}

TEST(Rest, ASheetSlipsFromTheFrictionAngleOn) {
  for (const double friction : {0.1, 0.3, 0.8}) {
    const double angle = std::atan(friction);
    const Slope below = onASlope(friction, 0.98 * angle);
    EXPECT_LT(std::abs(below.moved), 1e-6) << "friction " << friction;
    for (const double share : {1.02, 1.3}) {
      const Slope above = onASlope(friction, share * angle);
      const double expected = 9.81 * (std::sin(share * angle) - friction * std::cos(share * angle));
      EXPECT_NEAR(above.acceleration, expected, 0.02 * expected)
          << "friction " << friction << ", " << share << " of the angle";
    }
  }
}

}  // namespace
}  // namespace curtain
