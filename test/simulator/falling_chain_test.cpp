// SPDX-License-Identifier: BSD-3-Clause
//
// A chain that hangs by both ends, one of which is let go (test/truth/falling_N43.csv), or lies folded in half at its
// pin (falling_N43_fold.csv): the tip falls faster than freely, and cracks like a whip.
#include <gtest/gtest.h>

#include <cmath>

#include "chains.h"

namespace curtain_test {
namespace {

using namespace curtain;

constexpr int kRods = 43;
constexpr double kLength = 2.0, kApart = 1.0;  // of the chain, and of its ends [m]

// Places of the nodes of a discrete catenary of equal rods and masses: the tangents of the rods' angles are evenly
// spaced.
std::vector<std::array<double, 2>> catenary() {
  const double rod = kLength / kRods;
  const auto width = [&](double step) {
    double sum = 0.0;
    for (int k = 1; k <= kRods; ++k) sum += rod * std::cos(std::atan(step * (k - 0.5 * (kRods + 1))));
    return sum;
  };
  double low = 0.0, high = 100.0;
  for (int k = 0; k < 200; ++k) (width(0.5 * (low + high)) > kApart ? low : high) = 0.5 * (low + high);
  std::vector<std::array<double, 2>> nodes = {{0.0, 0.0}};
  for (int k = 1; k <= kRods; ++k) {
    const double angle = std::atan(low * (k - 0.5 * (kRods + 1)));
    nodes.push_back({nodes.back()[0] + rod * std::cos(angle), nodes.back()[1] + rod * std::sin(angle)});
  }
  return nodes;
}

// Down and up again: the fold is a rod across, as the truth's is.
std::vector<std::array<double, 2>> tightFold() {
  const double rod = kLength / kRods;
  std::vector<std::array<double, 2>> nodes;
  for (int k = 0; k <= kRods; ++k) {
    const int down = std::min(k, kRods - k);
    nodes.push_back({k <= kRods / 2 ? 0.0 : rod, -rod * down});
  }
  return nodes;
}

struct Fall {
  const char* truth;
  std::vector<std::array<double, 2>> start;
};

// How far the tip of the first column is from the truth at a time [m]; and how far below free fall, into `lead`.
double tipError(const Fall& fall, Method method, int substeps, double time, double& lead) {
  Scene scene = chainScene(kRods, 0.0);
  scene.solver.method = method;
  scene.solver.substeps = substeps;
  Simulator simulator(scene);
  std::vector<Vec3> positions, velocities;
  simulator.copyPositions(positions);
  velocities.assign(positions.size(), Vec3::Zero());
  const auto& nodes = fall.start;
  const double top = positions[0].z(), plane = positions[0].y();
  for (int i = 0; i <= kRods; ++i) {
    for (int j = 0; j < kChainColumns; ++j) {
      Vec3& at = positions[static_cast<std::size_t>(i * kChainColumns + j)];
      const auto& node = nodes[static_cast<std::size_t>(i)];
      at = Vec3(at.x(), plane + node[0], top + node[1]);
    }
  }
  EXPECT_TRUE(simulator.setState(positions, velocities).empty());
  makeFrames(simulator, static_cast<int>(std::lround(60.0 * time)));
  const TruthRow row = readTruth(fall.truth).at(static_cast<std::size_t>(std::lround(time / 0.005)) - 1);
  EXPECT_NEAR(std::stod(row.at("t")), simulator.time(), 1e-9);
  const Vec3 tip = simulator.position({kRods, 0});
  lead = nodes.back()[1] + std::stod(row.at("free_fall_y")) - (tip.z() - top);
  const double dx = tip.y() - plane - std::stod(row.at("tip_x")), dy = tip.z() - top - std::stod(row.at("tip_y"));
  return std::hypot(dx, dy);
}

Fall catenaryFall() { return {"falling_N43.csv", catenary()}; }
Fall foldedFall() { return {"falling_N43_fold.csv", tightFold()}; }

}  // namespace

TEST(FallingChain, TipFallsFasterThanFreely) {
  double lead = 0.0;
  const double coarse = tipError(catenaryFall(), Method::kLeapfrog, 16, 0.3, lead);
  const double fine = tipError(catenaryFall(), Method::kLeapfrog, 64, 0.3, lead);
  std::printf("tip off by %.2e m in 16 substeps, %.2e in 64; ahead of free fall by %.6f m\n", coarse, fine, lead);
  // Order 2 tells how far off the finer one is: 1/15 of what they differ by.
  EXPECT_NEAR(coarse / fine, 16.0, 1.0);
  EXPECT_LE(fine, 1e-7);
  EXPECT_NEAR(lead, 0.0565249267, 1e-7);  // the truth's summary
}

// The same without a word on substeps, and shortly before the crack at 0.52 s.
TEST(FallingChain, IsFollowedByDefault) {
  double lead = 0.0;
  const double early = tipError(catenaryFall(), Method::kAuto, 0, 0.3, lead);
  const double late = tipError(catenaryFall(), Method::kAuto, 0, 0.5, lead);
  std::printf("tip off by %.2e m at 0.3 s, %.2e at 0.5 s\n", early, late);
  // Two or three substeps a frame instead of 16: (16 / 2)^2 times as far off at first. What is off then turns a tip
  // that is 3 times as fast and much more bent by the end.
  EXPECT_LE(early, 64.0 * 1e-6);
  EXPECT_LE(late, 2e-3);
}

// Where the fold runs down the chain every rod turns over within a few substeps.
TEST(FoldedChain, TipFallsFasterThanFreely) {
  double lead = 0.0;
  const double coarse = tipError(foldedFall(), Method::kLeapfrog, 32, 0.3, lead);
  const double fine = tipError(foldedFall(), Method::kLeapfrog, 64, 0.3, lead);
  const double composed = tipError(foldedFall(), Method::kLeapfrog4, 8, 0.3, lead);
  const double later = tipError(foldedFall(), Method::kLeapfrog, 64, 0.5, lead);
  std::printf(
      "tip off by %.2e m in 32 substeps, %.2e in 64, %.2e in 8 of leapfrog4; at 0.5 s %.2e, ahead of free fall by %.6f "
      "m\n",
      coarse, fine, composed, later, lead);
  EXPECT_NEAR(coarse / fine, 4.0, 0.4);  // order 2
  EXPECT_LE(composed, fine);             // order 4: 8 substeps are worth more than 64 of order 2
  // 0.158 m ahead at 0.5 s: what is off by then is at most 1e-3 of that.
  EXPECT_LE(later, 0.158e-3);
  EXPECT_NEAR(lead, 0.1583, 0.158e-3);
}

}  // namespace curtain_test
