// SPDX-License-Identifier: BSD-3-Clause
//
// A chain that hangs by both ends, one of which is let go: the tip falls faster than freely, and cracks like a whip
// (test/truth/falling_N43.csv).
#include <gtest/gtest.h>

#include <cmath>

#include "chains.h"

namespace curtain_test {
namespace {

using namespace curtain;

constexpr int kRods = 43;
constexpr double kLength = 2.0, kApart = 1.0;  // of the chain, and of its ends [m]

// Places of the nodes of a discrete catenary of equal rods and masses: the tangents of the rods' angles are evenly spaced.
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

// How far the tip of the first column is from the truth at a time [m]; and how far below free fall, into `lead`.
double tipError(Method method, int substeps, double time, double& lead) {
  Scene scene = chainScene(kRods, 0.0);
  scene.solver.method = method;
  scene.solver.substeps = substeps;
  Simulator simulator(scene);
  std::vector<Vec3> positions, velocities;
  simulator.copyPositions(positions);
  velocities.assign(positions.size(), Vec3::Zero());
  const auto nodes = catenary();
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
  const TruthRow row = readTruth("falling_N43.csv").at(static_cast<std::size_t>(std::lround(time / 0.005)) - 1);
  EXPECT_NEAR(std::stod(row.at("t")), simulator.time(), 1e-9);
  const Vec3 tip = simulator.position({kRods, 0});
  lead = nodes.back()[1] + std::stod(row.at("free_fall_y")) - (tip.z() - top);
  const double dx = tip.y() - plane - std::stod(row.at("tip_x")), dy = tip.z() - top - std::stod(row.at("tip_y"));
  return std::hypot(dx, dy);
}

}  // namespace

TEST(FallingChain, TipFallsFasterThanFreely) {
  double lead = 0.0;
  const double coarse = tipError(Method::kLeapfrog, 16, 0.3, lead);
  const double fine = tipError(Method::kLeapfrog, 64, 0.3, lead);
  std::printf("tip off by %.2e m in 16 substeps, %.2e in 64; ahead of free fall by %.6f m\n", coarse, fine, lead);
  // Order 2 tells how far off the finer one is: 1/15 of what they differ by.
  EXPECT_NEAR(coarse / fine, 16.0, 1.0);
  EXPECT_LE(fine, 1e-7);
  EXPECT_NEAR(lead, 0.0565249267, 1e-7);  // the truth's summary
}

// The same without a word on substeps, and shortly before the crack at 0.52 s.
TEST(FallingChain, IsFollowedByDefault) {
  double lead = 0.0;
  const double early = tipError(Method::kAuto, 0, 0.3, lead);
  const double late = tipError(Method::kAuto, 0, 0.5, lead);
  std::printf("tip off by %.2e m at 0.3 s, %.2e at 0.5 s\n", early, late);
  // Two or three substeps a frame instead of 16: (16 / 2)^2 times as far off at first. What is off then turns a tip that is 3 times as
  // fast and much more bent by the end.
  EXPECT_LE(early, 64.0 * 1e-6);
  EXPECT_LE(late, 2e-3);
}

}  // namespace curtain_test
