// SPDX-License-Identifier: BSD-3-Clause
//
// Strips that slide off the edges of tables, over corners, bars and plates: nothing drives them, so their energy does
// not rise. Sizes, thickness, friction and rates are drawn.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include "curtain_sim/simulator.h"
#include "figures.h"
#include "scene/pi.h"
#include "simulator/scenes.h"

namespace curtain {
namespace {

using curtain_test::energyOf;
// What a frame may add to the energy, over m g L: the displacement in a substep that is as long as the links allow
// turns them by a tenth of a radian, whose square the leapfrog's energy wavers by.
constexpr double kWavers = 1e-2;

class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  // Not those of the standard library, which differ between libraries.
  double share() { return static_cast<double>(random_()) / 4294967296.0; }
  double within(double low, double high) { return low + (high - low) * share(); }
  template <std::size_t N>
  double of(const std::array<double, N>& values) {
    return values[static_cast<std::size_t>(share() * N)];
  }

 private:
  std::mt19937 random_;
};

// It lies flat and hangs over by a share of its length, or lies across a bar or a plate.
Scene stripScene(unsigned seed) {
  Dice dice(seed);
  Scene scene;
  const double link = 0.004 * std::pow(7.5, dice.share());
  scene.cloth.rows = static_cast<int>(dice.within(12.0, 60.0));
  scene.cloth.columns = static_cast<int>(dice.within(2.0, 8.0));
  const double length = link * (scene.cloth.rows - 1);
  scene.cloth.height = length;
  scene.cloth.width = std::min(length, link * (scene.cloth.columns - 1) * dice.within(0.7, 1.5));
  scene.cloth.surface_density = dice.of<3>({0.05, 0.2, 0.5});
  scene.pins.kind = PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 0.0;
  scene.contact.thickness = dice.of<5>({0.001, 0.002, 0.004, 0.006, 0.01});
  scene.contact.self = dice.share() < 0.5;
  scene.solver.frame_rate = dice.of<6>({20.0, 30.0, 60.0, 60.0, 120.0, 240.0});
  const double over = dice.within(0.35, 0.75) * length, side = 3.0 * length + 1.0;
  ObstacleParams solid;
  solid.name = "solid";
  solid.shape = ShapeKind::kBox;
  solid.friction = dice.of<6>({0.0, 0.0, 0.1, 0.3, 0.5, 1.0});
  double top = 1.0;
  switch (static_cast<int>(dice.within(0.0, 5.0))) {
    case 0:  // a table's edge
      solid.size = Vec3(side, side, 0.6);
      solid.pose.position = Vec3(-0.5 * side, 0.0, 0.7);
      break;
    case 1: {  // its corner
      const double turn = 0.25 * kPi + dice.within(-0.35, 0.35);
      solid.size = Vec3(side, side, 0.6);
      solid.pose.orientation = Rotation(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
      solid.pose.position = solid.pose.orientation * Vec3(-0.5 * side, -0.5 * side, 0.0);
      solid.pose.position.z() = 0.7;
      break;
    }
    case 2:  // a bar
      solid.shape = dice.share() < 0.5 ? ShapeKind::kCylinder : ShapeKind::kCapsule;
      solid.radius = link * dice.within(0.5, 6.0);
      solid.length = 2.0 * scene.cloth.width + 0.2;
      solid.pose.position = Vec3(0.0, 0.0, 1.0);
      solid.pose.orientation = Rotation(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()));
      top += solid.radius;
      break;
    case 3:  // an upright plate
      solid.size = Vec3(dice.within(0.001, 0.02), 2.0 * scene.cloth.width + 0.2, 0.5);
      solid.pose.position = Vec3(0.0, 0.0, 0.75);
      break;
    default:  // a lying one
      solid.size = Vec3(dice.within(0.1, 0.5) * length, 2.0 * scene.cloth.width + 0.2, dice.within(0.001, 0.02));
      solid.pose.position = Vec3(0.0, 0.0, 1.0 - 0.5 * solid.size.z());
      break;
  }
  scene.obstacles = {solid};
  scene.hang.from = Vec3(over - length, -0.5 * scene.cloth.width, top + 1.02 * scene.contact.thickness + 1e-3);
  scene.hang.to = scene.hang.from + Vec3(0.0, scene.cloth.width, 0.0);
  scene.hang.tilt = 0.5 * kPi;
  return scene;
}

TEST(SlidingStrips, GainNoEnergy) {
  double worst = 0.0;
  long last_resort = 0, substeps = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const Scene scene = stripScene(seed);
    Simulator simulator(scene);
    const double unit = scene.cloth.surface_density * scene.cloth.width * scene.cloth.height * scene.gravity.norm() *
                        scene.cloth.height;
    const double start = energyOf(simulator);
    double before = start, rise = 0.0, above = 0.0;
    while (simulator.time() < 1.0 && simulator.energy().kinetic < unit) {  // then it has left
      simulator.step();
      const double now = energyOf(simulator);
      rise = std::max(rise, now - before);
      above = std::max(above, now - start);
      before = now;
    }
    curtain_test::keepFigure("sliding strips, a frame's rise", rise / unit);
    curtain_test::keepFigure("sliding strips, above the start", above / unit);
    EXPECT_LE(rise, kWavers * unit) << "a frame's rise, seed " << seed;
    EXPECT_LE(above, kWavers * unit) << "above the start, seed " << seed;
    worst = std::max(worst, rise / unit);
    last_resort += static_cast<long>(simulator.statistics().last_resort_substeps);
    substeps += static_cast<long>(simulator.statistics().substeps);
  }
  std::printf("a frame rises by %.1e m g L at most; %ld of %ld substeps by the last resort\n", worst, last_resort,
              substeps);
}

}  // namespace
}  // namespace curtain
