// SPDX-License-Identifier: BSD-3-Clause
//
// Small oscillations: the frequencies of a chain's first five modes against test/truth/modes_frequencies.csv. Released
// straight at a small angle all modes move at once; the motion is projected on each mode's shape (modes_shapes.csv;
// with equal masses the shapes are orthogonal), and the samples of what is left, q'' + omega^2 q = 0, obey
// q(n+s) + q(n-s) = 2 cos(omega s dt) q(n): least squares over the whole run.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "simulator/chains.h"

namespace curtain {
namespace {

constexpr std::size_t kModes = 5;
constexpr int kFrames = 1200;
// [rad] Frequencies of a pendulum go down by the angle's square / 16. A chain's rods turn further than it was released
// at and modes move each other's, which is of the same order: frequencies are asked for to the angle's square.
constexpr double kAngle = 1e-3;
constexpr double kOfAngle = kAngle * kAngle;

struct Mode {
  double frequency = 0.0;     // [rad/s]
  std::vector<double> shape;  // a node each, the support first
};

std::array<Mode, kModes> modesOfTruth(int rods) {
  std::array<Mode, kModes> modes;
  for (const auto& row : curtain_test::readTruth("modes_frequencies.csv")) {
    const auto mode = static_cast<std::size_t>(std::stoi(row.at("mode")) - 1);
    if (row.at("N") == std::to_string(rods) && mode < kModes) {
      modes[mode].frequency = std::stod(row.at("omega_rad_s(L=2,g=9.81)"));
    }
  }
  for (const auto& row : curtain_test::readTruth("modes_shapes.csv")) {
    const auto mode = static_cast<std::size_t>(std::stoi(row.at("mode")) - 1);
    if (row.at("N") == std::to_string(rods) && mode < kModes) {
      modes[mode].shape.push_back(std::stod(row.at("x_over_x_tip")));
    }
  }
  return modes;
}

// The stride is about a quarter period, where the cosine is steepest.
double fittedFrequency(const std::vector<double>& q, double expected, double dt) {
  const auto stride = static_cast<std::size_t>(std::lround(0.5 * curtain_test::kPi / (expected * dt)));
  double with = 0.0, own = 0.0;
  for (std::size_t n = stride; n + stride < q.size(); ++n) {
    with += q[n] * (q[n + stride] + q[n - stride]);
    own += 2.0 * q[n] * q[n];
  }
  return std::acos(with / own) / (static_cast<double>(stride) * dt);
}

std::array<double, kModes> measuredFrequencies(int rods, Method method, int substeps,
                                               const std::array<Mode, kModes>& modes) {
  Scene scene = curtain_test::chainScene(rods, kAngle * 180.0 / curtain_test::kPi, 2);
  scene.solver.method = method;
  scene.solver.substeps = substeps;
  scene.solver.stretch_tolerance = 1e-10;  // the modes' own shortening is angle^2 / 2, below what 1e-3 would let pass
  Simulator simulator(scene);
  std::array<std::vector<double>, kModes> q;
  std::vector<Vec3> x;
  for (int frame = 0; frame < kFrames; ++frame) {
    simulator.step();
    simulator.copyPositions(x);
    for (std::size_t m = 0; m < kModes; ++m) {
      double sum = 0.0;
      for (std::size_t i = 1; i < modes[m].shape.size(); ++i) sum += modes[m].shape[i] * x[2 * i].y();
      q[m].push_back(sum);
    }
  }
  std::array<double, kModes> found{};
  for (std::size_t m = 0; m < kModes; ++m) {
    found[m] = fittedFrequency(q[m], modes[m].frequency, 1.0 / scene.solver.frame_rate);
  }
  return found;
}

class Modes : public ::testing::TestWithParam<int> {};

// Leapfrog at 8 substeps has the frequencies within 1e-4, and is off by what theory says and nothing else: it swings
// with (2 / h) asin(h omega / 2).
TEST_P(Modes, OfLeapfrogHaveItsFrequencies) {
  const int rods = GetParam();
  const std::array<Mode, kModes> modes = modesOfTruth(rods);
  const std::array<double, kModes> found = measuredFrequencies(rods, Method::kLeapfrog, 8, modes);
  const double h = 1.0 / 480.0;
  for (std::size_t m = 0; m < kModes; ++m) {
    ASSERT_EQ(modes[m].shape.size(), static_cast<std::size_t>(rods) + 1);
    const double exact = modes[m].frequency;
    const double predicted = 2.0 / h * std::asin(0.5 * h * exact);
    std::printf("leapfrog, %d rods, mode %zu: %+.2e of the exact frequency, %+.2e of leapfrog's\n", rods, m + 1,
                found[m] / exact - 1.0, found[m] / predicted - 1.0);
    EXPECT_NEAR(found[m] / exact, 1.0, 1e-4) << "mode " << m + 1;
    EXPECT_NEAR(found[m] / predicted, 1.0, kOfAngle) << "mode " << m + 1;
  }
}

// Leapfrog4 at 8 substeps: the step's share is some hundredths of (h omega)^4, which is 2e-6 for the fastest of the
// five.
TEST_P(Modes, OfLeapfrog4AreExact) {
  const int rods = GetParam();
  const std::array<Mode, kModes> modes = modesOfTruth(rods);
  const std::array<double, kModes> found = measuredFrequencies(rods, Method::kLeapfrog4, 8, modes);
  for (std::size_t m = 0; m < kModes; ++m) {
    const double exact = modes[m].frequency;
    std::printf("leapfrog4, %d rods, mode %zu: %+.2e of the exact frequency\n", rods, m + 1, found[m] / exact - 1.0);
    EXPECT_NEAR(found[m] / exact, 1.0, kOfAngle + std::pow(exact / 480.0, 4)) << "mode " << m + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(Rods, Modes, ::testing::Values(5, 10, 43));

}  // namespace
}  // namespace curtain
