// SPDX-License-Identifier: BSD-3-Clause
//
// Twist: its force is the slope of its energy and leaves no momentum, cloth that bends along the bias has the rigidity
// that is asked for, flat and sheared cloth and such that bends along its threads has none.
#include "parts/twist/twist.h"

#include <gtest/gtest.h>

#include <cmath>

#include "parts/elastic_fabric.h"

namespace curtain {
namespace {

using curtain_test::Fabric;

constexpr double kTwist = 3e-5;  // D_t [N m]

ClothParams twisted(const Fabric& fabric) {
  ClothParams cloth = fabric.scene.cloth;
  cloth.bending_warp = 2e-5;
  cloth.bending_weft = 4e-5;
  cloth.bending_bias = 0.25 * (2e-5 + 4e-5) + kTwist;
  return cloth;
}

TEST(Twist, ForceIsTheEnergysSlopeAndLeavesNoMomentum) {
  for (const Scene& scene : curtain_test::fabricScenes()) {
    Fabric fabric(scene);
    curtain_test::shake(fabric.pattern, 0.03, 3, fabric.position);
    Twist twist(twisted(fabric), fabric.pattern, fabric.workers);
    curtain_test::expectSlope(fabric, twist);
  }
}

// Of flat cells, sheared and tapered ones too, six times the volume is a difference of products of 1e-2 m^3.
TEST(Twist, FlatAndShearedClothHasNone) {
  for (const Scene& scene : curtain_test::fabricScenes()) {
    if (scene.cloth.closed) continue;  // it starts around, not flat
    Fabric fabric(scene);
    Twist twist(twisted(fabric), fabric.pattern, fabric.workers);
    for (std::size_t n = 0; n < fabric.pattern.grid.size(); ++n) {
      const Vec3 at = fabric.position.at(n);
      fabric.position.set(n, at + Vec3(0.3 * at.z(), 0.0, 0.0));
    }
    double energy = 0.0;
    const Field3& force = twist.forceAt(fabric.position, energy);
    for (std::size_t n = 0; n < fabric.pattern.grid.size(); ++n) EXPECT_LT(force.at(n).norm(), 1e-12);
  }
}

// Wound on a cylinder whose axis makes this angle with the weft.
void wind(Fabric& fabric, double curvature, double angle) {
  const Vec3 axis(std::cos(angle), 0.0, std::sin(angle)), across(-std::sin(angle), 0.0, std::cos(angle));
  for (std::size_t n = 0; n < fabric.pattern.grid.size(); ++n) {
    const Vec3 at = fabric.position.at(n);
    const double along = at.dot(axis), turn = curvature * at.dot(across);
    fabric.position.set(n,
                        along * axis + (std::sin(turn) * across + (1.0 - std::cos(turn)) * Vec3::UnitY()) / curvature);
  }
}

// D_t / 2 curvature^2 for each area, along the bias: the rest of B_45 is that of warp and weft. The corners of a cell
// lie on an arc by turns of phi = curvature l / sqrt(2), and enclose a volume of sin(phi) (1 - cos(phi)): by (phi /
// 2)^2 less, to leading order, than the curvature's square has. The energy lacks twice that.
TEST(Twist, BendsAlongTheBiasByItsRigidity) {
  constexpr double kCurvature = 2.0, kLink = 0.025;
  for (const double angle : {0.25, -0.25, 0.0, 0.5}) {
    Fabric fabric(curtain_test::flatScene(33, 33, 0.8, 0.8));
    Twist twist(twisted(fabric), fabric.pattern, fabric.workers);
    wind(fabric, kCurvature, angle * 3.14159265358979323846);
    double energy = 0.0;
    twist.forceAt(fabric.position, energy);
    const double along_bias = 0.5 * kTwist * kCurvature * kCurvature * 0.8 * 0.8;
    const double square = std::pow(kCurvature * kLink, 2);
    const double expected = std::abs(angle) == 0.25 ? along_bias * (1.0 - square / 4.0) : 0.0;
    EXPECT_NEAR(energy, expected, square * square * along_bias) << angle;
  }
}

TEST(Twist, NoFrequencyIsAboveItsBound) {
  for (const Scene& scene : {curtain_test::flatScene(7, 6), curtain_test::unevenScene(7, 6, false)}) {
    const Fabric fabric(scene);
    Twist twist(twisted(fabric), fabric.pattern, fabric.workers);
    const double largest = curtain_test::largestOmegaSquared(fabric, twist);
    EXPECT_LE(largest, twist.omegaSquared() * (1.0 + 1e-6));
    EXPECT_GT(largest, 0.2 * twist.omegaSquared());
  }
}

// The bias may be no stiffer than its warp and weft make it.
TEST(Twist, IsNoneBelowWhatLinesGive) {
  const Fabric fabric(curtain_test::flatScene(7, 6));
  ClothParams cloth = twisted(fabric);
  cloth.bending_bias = 1.4e-5;
  EXPECT_FALSE(Twist(cloth, fabric.pattern, fabric.workers).any());
}

}  // namespace
}  // namespace curtain
