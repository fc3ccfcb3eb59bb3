// SPDX-License-Identifier: BSD-3-Clause
//
// Bending against others' figures: the heavy elastica (test/truth/elastica_cantilever.csv), the overhang of measured
// fabrics (test/truth/fabrics.csv), the frequencies of a clamped strip.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "figures.h"
#include "simulator/chains.h"
#include "simulator/scenes.h"
#include "simulator/strips.h"

namespace curtain {
namespace {

using curtain_test::kGravity;
using curtain_test::Overhang;
using curtain_test::Strip;

// The strip whose weight bends it by Gamma = density g L^3 / B.
Strip stripOf(double gamma, int rods, bool along_warp) {
  Strip strip;
  strip.rods = rods;
  strip.along_warp = along_warp;
  strip.rigidity = strip.density * kGravity * std::pow(strip.length, 3) / gamma;
  return strip;
}

// Steps so short that nothing gives way: their stiffest joint, at the clamp, has omega^2 below 40 B / (density l^4).
int substepsFor(const Strip& strip) {
  const double rod = strip.length / strip.rods;
  const double omega = std::sqrt(40.0 * strip.rigidity / strip.density) / (rod * rod);
  return static_cast<int>(std::ceil(omega / 1.5 / 60.0));
}

Overhang elastica(double gamma, int rods, bool along_warp) {
  const Strip strip = stripOf(gamma, rods, along_warp);
  Scene scene = curtain_test::stripScene(strip);
  scene.solver.method = Method::kLeapfrog;
  scene.solver.substeps = substepsFor(strip);
  scene.solver.max_substeps = 10000;
  scene.solver.stretch_tolerance = 1e-8;
  return curtain_test::sinkToRest(strip, scene);
}

class Elastica : public ::testing::TestWithParam<double> {
 protected:
  Overhang truth() const {
    for (const auto& row : curtain_test::readTruth("elastica_cantilever.csv")) {
      if (std::stod(row.at("Gamma")) == GetParam())
        return {std::stod(row.at("H_over_L")), std::stod(row.at("W_over_L"))};
    }
    ADD_FAILURE() << "no such row";
    return {};
  }
};

TEST_P(Elastica, OfFortyRodsIsWithinAThousandthOfItsLength) {
  const Overhang exact = truth();
  for (const bool along_warp : {true, false}) {
    const Overhang found = elastica(GetParam(), 40, along_warp);
    std::printf("Gamma %g, %s: drop off by %+.1e, reach by %+.1e of the length\n", GetParam(),
                along_warp ? "warp" : "weft", found.drop - exact.drop, found.reach - exact.reach);
    curtain_test::keepFigure("elastica of " + std::to_string(static_cast<int>(GetParam())) + ", off by",
                             std::hypot(found.drop - exact.drop, found.reach - exact.reach));
    EXPECT_NEAR(found.drop, exact.drop, 1e-3);
    EXPECT_NEAR(found.reach, exact.reach, 1e-3);
  }
}

// Hencky's line converges with the square of the rod's length.
TEST_P(Elastica, ConvergesWithTheSquareOfTheRod) {
  const Overhang exact = truth(), coarse = elastica(GetParam(), 20, true), fine = elastica(GetParam(), 40, true);
  const double order = std::log2(std::hypot(coarse.drop - exact.drop, coarse.reach - exact.reach) /
                                 std::hypot(fine.drop - exact.drop, fine.reach - exact.reach));
  std::printf("Gamma %g: order %.3f from 20 to 40 rods\n", GetParam(), order);
  curtain_test::keepFigure("elastica of " + std::to_string(static_cast<int>(GetParam())) + ", order", order);
  EXPECT_GE(order, 1.9);
}

INSTANTIATE_TEST_SUITE_P(Loads, Elastica, ::testing::Values(1.0, 5.0, 8.0));

// The tip's motion after a blow on it, at the ends of frames.
std::vector<double> ringing(const Strip& strip, double seconds) {
  Scene scene = curtain_test::stripScene(strip);
  scene.gravity.setZero();
  scene.solver.method = Method::kLeapfrog;
  scene.solver.substeps = substepsFor(strip);
  scene.solver.max_substeps = 10000;
  scene.solver.stretch_tolerance = 1e-8;
  const NodeIndex tip = curtain_test::nodeOf(strip, strip.rods + 1);
  for (const NodeIndex& node : {tip, strip.along_warp ? NodeIndex{tip.row, 1} : NodeIndex{1, tip.column}}) {
    DragParams blow;
    blow.id = "blow" + std::to_string(scene.drag.size());
    blow.node = node;
    blow.force = Vec3(0.0, 0.0, 1e-4);  // swings by 2 mm: its arc is flat to 4e-6
    blow.end = 0.05;
    scene.drag.push_back(blow);
  }
  Simulator simulator(scene);
  std::vector<double> motion;
  while (simulator.time() < seconds) {
    simulator.step();
    if (simulator.time() > 0.05) motion.push_back(simulator.position(curtain_test::nodeOf(strip, strip.rods + 1)).z());
  }
  return motion;
}

// Share of a frequency [rad/s] in a motion, seen through Hann's window.
double share(const std::vector<double>& motion, double omega) {
  double cosine = 0.0, sine = 0.0;
  const auto count = static_cast<double>(motion.size());
  for (std::size_t k = 0; k < motion.size(); ++k) {
    const auto at = static_cast<double>(k);
    const double value = (1.0 - std::cos(2.0 * curtain_test::kPi * at / count)) * motion[k];
    cosine += value * std::cos(omega * at / 60.0);
    sine += value * std::sin(omega * at / 60.0);
  }
  return std::hypot(cosine, sine);
}

// Where the share is largest, between neighbours of a frequency that are nearer to it than the window is wide.
double peakNear(const std::vector<double>& motion, double omega) {
  double low = 0.98 * omega, high = 1.02 * omega;
  while (high - low > 1e-6 * omega) {
    const double left = low + (high - low) / 3.0, right = high - (high - low) / 3.0;
    if (share(motion, left) < share(motion, right))
      low = left;
    else
      high = right;
  }
  return 0.5 * (low + high);
}

// Frequencies beta^2 sqrt(B / density) / L^2 of the clamped beam, cos(beta) cosh(beta) = -1. The error of Hencky's line
// grows with the square of rod over wave: of mode n it is that of the first with a rod times n, a thousandth at 40
// rods.
TEST(Bending, ClampedStripsRingAtTheirFrequencies) {
  constexpr int kRods = 25;
  const double beta[] = {1.8751040687, 4.6940911330, 7.8547574382};
  for (int mode = 0; mode < 3; ++mode) {
    Strip strip;
    strip.along_warp = mode % 2 == 0;
    strip.rods = kRods * (mode + 1);
    const double omega = beta[mode] * beta[mode] * std::sqrt(strip.rigidity / strip.density);
    // 30 periods: the window's lobe of 1 / 15 is wider than the search. Eight of the first mode, which swings most: it
    // leaks into others by the third power of their distance in periods.
    const double periods = std::max(30.0, 8.0 * omega / curtain_test::lowestFrequency(strip));
    const double found = peakNear(ringing(strip, periods * 2.0 * curtain_test::kPi / omega), omega);
    std::printf("mode %d, %d rods: frequency off by %+.1e\n", mode + 1, strip.rods, found / omega - 1.0);
    curtain_test::keepFigure("clamped strip, mode " + std::to_string(mode + 1) + ", off by",
                             std::abs(found / omega - 1.0));
    EXPECT_NEAR(found / omega, 1.0, 1e-3 * std::pow(40.0 / kRods, 2)) << "mode " << mode + 1;
  }
}

// Peirce's test (1930): the overhang whose chord hangs at 41.5 degrees is twice the bending length c = (B / w g)^(1/3);
// for the heavy elastica 2.0003 c. With 32 substeps, since with auto's few the strings of such short links tremble.
double chordAngle(const Strip& strip) {
  Scene scene = curtain_test::stripScene(strip);
  scene.solver.substeps = 32;
  const Overhang found = curtain_test::sinkToRest(strip, scene);
  return std::atan2(found.drop, found.reach) * 180.0 / curtain_test::kPi;
}

TEST(Peirce, OverhangsOfRealFabricsAreWithinAHundredth) {
  int fabrics = 0;
  for (const auto& row : curtain_test::readTruth("fabrics.csv")) {
    const bool along_warp = fabrics++ % 2 == 0;  // both directions are one code's two calls: in turn
    Strip strip;
    strip.density = std::stod(row.at("surface_density_kg_m2"));
    strip.along_warp = along_warp;
    strip.rigidity = std::stod(row.at(along_warp ? "bending_warp_N_m" : "bending_weft_N_m"));
    const double overhang = 2.0003 * std::cbrt(strip.rigidity / (strip.density * kGravity));
    strip.length = 0.99 * overhang;
    EXPECT_LT(chordAngle(strip), 41.5) << "fabric " << fabrics;
    strip.length = 1.01 * overhang;
    EXPECT_GT(chordAngle(strip), 41.5) << "fabric " << fabrics;
  }
  EXPECT_EQ(fabrics, 36);
}

}  // namespace
}  // namespace curtain
