// SPDX-License-Identifier: BSD-3-Clause
//
// Shear and the wefts' push: their forces are the slopes of their energies and leave no momentum, a picture frame is
// pulled as the definition of the rigidity says, and no frequency is above the bound that steps follow.
#include "parts/shear/shear.h"

#include <gtest/gtest.h>

#include <cmath>

#include "parts/elastic_fabric.h"
#include "parts/weft_push/weft_push.h"
#include "scene/pi.h"

namespace curtain {
namespace {

using curtain_test::Fabric;

constexpr double kShearRigidity = 20.0;  // [N/m]

ClothParams sheared(const Fabric& fabric) {
  ClothParams cloth = fabric.scene.cloth;
  cloth.shear = kShearRigidity;
  cloth.bending_weft = 1e-4;
  return cloth;
}

TEST(Shear, ForceIsTheEnergysSlopeAndLeavesNoMomentum) {
  for (const Scene& scene : curtain_test::fabricScenes()) {
    Fabric fabric(scene);
    curtain_test::shake(fabric.pattern, 0.03, 3, fabric.position);
    Shear shear(sheared(fabric), fabric.pattern, fabric.workers);
    curtain_test::expectSlope(fabric, shear);
  }
}

TEST(WeftPush, ForceIsTheEnergysSlopeAndLeavesNoMomentum) {
  for (const Scene& scene : curtain_test::fabricScenes()) {
    Fabric fabric(scene);
    curtain_test::shake(fabric.pattern, 0.03, 3, fabric.position);
    WeftPush push(sheared(fabric), fabric.pattern);
    curtain_test::expectSlope(fabric, push);
  }
}

// Flat cloth is at rest, and so is tapered cloth whose rows all have their own width.
TEST(Shear, FlatClothHasNone) {
  for (const Scene& scene : curtain_test::fabricScenes()) {
    if (scene.cloth.closed) continue;  // it starts around, not flat
    Fabric fabric(scene);
    const ClothPattern& pattern = fabric.pattern;
    for (std::size_t n = 0; scene.cloth.hem_width && n < pattern.grid.size(); ++n) {
      const double share = pattern.weft_coordinate[n % static_cast<std::size_t>(pattern.grid.stride)] - 0.5;
      const double depth = pattern.warp_coordinate[n], lean = share * (1.0 - *scene.cloth.hem_width);
      fabric.position.set(n, Vec3(share - depth * lean, 0.0, -depth * std::sqrt(1.0 - lean * lean)));
    }
    Shear shear(sheared(fabric), fabric.pattern, fabric.workers);
    double energy = 0.0;
    const Field3& force = shear.forceAt(fabric.position, energy);
    EXPECT_NEAR(energy, 0.0, 1e-20);
    for (std::size_t n = 0; n < fabric.pattern.grid.size(); ++n) EXPECT_LT(force.at(n).norm(), 1e-12 * kShearRigidity);
  }
}

// Sheared by gamma at constant lengths the top row is pulled along by G W sin(gamma), and the energy is G A sin^2 / 2.
TEST(Shear, PullsAtAPictureFrameByItsRigidity) {
  Fabric fabric(curtain_test::flatScene(6, 9, 0.8, 1.3));
  Shear shear(sheared(fabric), fabric.pattern, fabric.workers);
  const Grid& grid = fabric.pattern.grid;
  for (const double gamma : {0.05, 0.3, -0.6}) {
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = 0; j < grid.columns; ++j) {
        const double down = 0.8 * i / (grid.rows - 1);
        fabric.position.set(grid.index(i, j),
                            {1.3 * j / (grid.columns - 1) + down * std::sin(gamma), 0.0, -down * std::cos(gamma)});
      }
    }
    double energy = 0.0, pull = 0.0;
    const Field3& force = shear.forceAt(fabric.position, energy);
    for (int j = 0; j < grid.columns; ++j) pull += force.at(grid.index(0, j)).x();
    EXPECT_NEAR(pull, kShearRigidity * 1.3 * std::sin(gamma), 1e-12 * kShearRigidity);
    EXPECT_NEAR(energy, 0.5 * kShearRigidity * 0.8 * 1.3 * std::pow(std::sin(gamma), 2), 1e-12 * kShearRigidity);
  }
}

// Links of the length l on a cylinder whose axis is along the bias: each goes on by c cos(turn / 2) and across by c.
TEST(Shear, ClothRolledAlongTheBiasHasNone) {
  constexpr int kLinks = 8;
  Fabric fabric(curtain_test::flatScene(kLinks + 1, kLinks + 1, 0.8, 0.8));
  Shear shear(sheared(fabric), fabric.pattern, fabric.workers);
  const Grid& grid = fabric.pattern.grid;
  for (const double turn : {0.01, 0.2, 0.8}) {
    const double cosine = std::cos(0.5 * turn), across = 0.8 / kLinks / std::sqrt(1.0 + cosine * cosine);
    const double radius = 0.5 * across / std::sin(0.5 * turn);
    for (int i = 0; i < grid.rows; ++i) {
      for (int j = 0; j < grid.columns; ++j)
        fabric.position.set(grid.index(i, j), {radius * std::sin(turn * (j - i)), radius * std::cos(turn * (j - i)),
                                               across * cosine * (i + j)});
    }
    for (const std::size_t next : {grid.index(3, 5), grid.index(4, 4)})
      ASSERT_NEAR((fabric.position.at(next) - fabric.position.at(grid.index(3, 4))).norm(), 0.8 / kLinks, 1e-14);
    double energy = 0.0;
    const Field3& force = shear.forceAt(fabric.position, energy);
    EXPECT_NEAR(energy, 0.0, 1e-20) << turn;
    for (std::size_t n = 0; n < grid.size(); ++n) EXPECT_LT(force.at(n).norm(), 1e-12 * kShearRigidity) << turn;
  }
}

TEST(Shear, NoFrequencyIsAboveItsBound) {
  for (const Scene& scene : {curtain_test::flatScene(7, 6), curtain_test::unevenScene(7, 6, false)}) {
    const Fabric fabric(scene);
    Shear shear(sheared(fabric), fabric.pattern, fabric.workers);
    const double largest = curtain_test::largestOmegaSquared(fabric, shear);
    EXPECT_LE(largest, shear.omegaSquared() * (1.0 + 1e-6));
    EXPECT_GT(largest, 0.3 * shear.omegaSquared());
  }
}

// pi^2 B / l^2 for each metre of width, along the link: half of it for the first row, which is half as wide.
TEST(WeftPush, IsTheEulerLoadOfALink) {
  const Fabric fabric(curtain_test::flatScene(5, 4, 0.8, 1.2));
  WeftPush push(sheared(fabric), fabric.pattern);
  double energy = 0.0;
  const Field3& force = push.forceAt(fabric.position, energy);
  EXPECT_NEAR(energy, 0.0, 1e-18);
  const double load = kPi * kPi * 1e-4 / (0.4 * 0.4);
  EXPECT_NEAR(force.at(fabric.pattern.grid.index(2, 0)).x(), -load * 0.2, 1e-12 * load);
  EXPECT_NEAR(force.at(fabric.pattern.grid.index(0, 3)).x(), load * 0.1, 1e-12 * load);
  EXPECT_NEAR(force.at(fabric.pattern.grid.index(2, 1)).norm(), 0.0, 1e-12 * load);
}

}  // namespace
}  // namespace curtain
