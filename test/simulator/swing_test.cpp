// SPDX-License-Identifier: BSD-3-Clause
//
// The scene swing against the exact chain: every method's error after one second, its order, and the rods' lengths.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"
#include "truth_table.h"

namespace curtain {
namespace {

struct SwingResult {
  double position_rms = 0.0;  // [m], over the free rows
  double velocity_rms = 0.0;  // [m/s]
  double warp_error_max = 0.0;
  double milliseconds = 0.0;
};

Scene swing(int rods) {
  Scene scene = readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/test/scenes/swing.yaml").scene;
  scene.cloth.rows = rods + 1;
  return scene;
}

// The cloth turns towards -y, the truth's chain towards +x.
SwingResult run(const Scene& scene, double duration) {
  Simulator simulator(scene);
  const auto frames = static_cast<int>(std::lround(duration * scene.solver.frame_rate));
  for (int frame = 0; frame < frames; ++frame) simulator.step();
  const int rods = scene.cloth.rows - 1;
  const auto table = curtain_test::readTruth("traj_N" + std::to_string(rods) + "_A45.csv");
  const auto& row = table.at(static_cast<std::size_t>(std::lround(duration / 0.05)) - 1);
  EXPECT_NEAR(std::stod(row.at("t")), duration, 1e-9);
  std::vector<Vec3> x, v;
  simulator.copyPositions(x);
  simulator.copyVelocities(v);
  SwingResult result;
  for (int i = 1; i <= rods; ++i) {
    const std::string k = std::to_string(i);
    const Vec3 x_true(0.0, -std::stod(row.at("x" + k)), std::stod(row.at("y" + k)));
    const Vec3 v_true(0.0, -std::stod(row.at("vx" + k)), std::stod(row.at("vy" + k)));
    for (int j = 0; j < scene.cloth.columns; ++j) {
      const auto n = static_cast<std::size_t>(i * scene.cloth.columns + j);
      Vec3 error = x[n] - x_true;
      error.x() = 0.0;  // along the hung edge; the columns' own places
      result.position_rms += error.squaredNorm();
      result.velocity_rms += (v[n] - v_true).squaredNorm();
    }
  }
  const double samples = static_cast<double>(rods) * scene.cloth.columns;
  result.position_rms = std::sqrt(result.position_rms / samples);
  result.velocity_rms = std::sqrt(result.velocity_rms / samples);
  const Statistics& s = simulator.statistics();
  result.warp_error_max = std::max(s.warp_stretch_max, s.warp_compression_max);
  result.milliseconds = 1e3 * s.step_seconds_sum;
  return result;
}

SwingResult run(Method method, int substeps, int rods = 43) {
  Scene scene = swing(rods);
  scene.solver.method = method;
  scene.solver.substeps = substeps;
  return run(scene, 1.0);
}

TEST(Swing, EveryMethodsErrorIsPrinted) {
  std::printf("%-10s %9s %14s %14s %12s %8s\n", "method", "substeps", "rms x [mm]", "rms v [mm/s]", "rod error", "ms");
  for (const std::string& name : methodNames()) {
    for (const int substeps : {0, 2, 4, 8, 16, 32}) {
      const SwingResult r = run(*methodFromName(name), substeps);
      std::printf("%-10s %9s %14.5f %14.4f %12.1e %8.2f\n", name.c_str(),
                  substeps == 0 ? "default" : std::to_string(substeps).c_str(), 1e3 * r.position_rms,
                  1e3 * r.velocity_rms, r.warp_error_max, r.milliseconds);
      EXPECT_TRUE(std::isfinite(r.position_rms)) << name << " " << substeps;
    }
  }
}

// The bounds are the ones asked of the package: 1 mm by default, 0.1 mm at 8 substeps, rods within 1e-3 always.
TEST(Swing, DefaultIsWithinAMillimetre) {
  const SwingResult r = run(Method::kAuto, 0);
  EXPECT_LT(r.position_rms, 1e-3);
  EXPECT_LT(r.warp_error_max, 1e-3);
}

TEST(Swing, EightSubstepsAreWithinATenthOfAMillimetre) {
  const SwingResult r = run(Method::kAuto, 8);
  EXPECT_LT(r.position_rms, 1e-4);
  EXPECT_LT(r.warp_error_max, 1e-3);
}

// Order 2: halving the step quarters the error, up to the next term of the expansion, (h omega)^2 / 12 < 0.1 relative
// at 8 substeps for the highest frequency that moves noticeably.
TEST(Swing, LeapfrogIsOfSecondOrderInPositionsAndVelocities) {
  const SwingResult coarse = run(Method::kLeapfrog, 8);
  const SwingResult fine = run(Method::kLeapfrog, 16);
  EXPECT_NEAR(coarse.position_rms / fine.position_rms, 4.0, 0.4);
  EXPECT_NEAR(coarse.velocity_rms / fine.velocity_rms, 4.0, 0.6);
}

TEST(Swing, ImplicitIsOfFirstOrder) {
  const double ratio = run(Method::kImplicit, 16).position_rms / run(Method::kImplicit, 32).position_rms;
  EXPECT_NEAR(ratio, 2.0, 0.2);
}

class ChainLength : public ::testing::TestWithParam<int> {};

// Chains of every length follow the truth, and the error goes down with the square of the step.
TEST_P(ChainLength, ConvergesToTheExactMotion) {
  const int rods = GetParam();
  Scene scene = swing(rods);
  scene.cloth.columns = 2;
  scene.solver.stretch_tolerance = 1e-10;
  scene.solver.substeps = 32;
  const double coarse = run(scene, 1.0).position_rms;
  scene.solver.substeps = 64;
  const double fine = run(scene, 1.0).position_rms;
  EXPECT_LT(fine, 3e-6);  // 43 rods: 0.62 mm at 2 substeps, / 32^2
  EXPECT_NEAR(coarse / fine, 4.0, 0.4);
}

INSTANTIATE_TEST_SUITE_P(Rods, ChainLength, ::testing::Values(1, 2, 5, 10, 20, 43));

}  // namespace
}  // namespace curtain
