// SPDX-License-Identifier: BSD-3-Clause
//
// Where a chain in the wind comes to rest: the straight line. Nets: nets_test.cpp.
#include <gtest/gtest.h>

#include <cmath>

#include "curtain_sim/simulator.h"
#include "truth_table.h"

namespace curtain {
namespace {

class WindEquilibrium : public ::testing::TestWithParam<double> {};

// A chain in a uniform wind under Eq. (3), whose force is along the wind and goes with cos psi, rests on a straight
// line (law A of the table). The disc is 1e5 m away, so that 1 + |d|^2 varies by 2 L / d = 4e-5 over the cloth; bound:
// that, and what motion the damping leaves after 20 s.
TEST_P(WindEquilibrium, IsTheStraightLine) {
  const double r = GetParam();
  double theta = -1.0;
  for (const auto& row : curtain_test::readTruth("wind_chain.csv")) {
    if (row.at("law") == "A" && std::abs(std::stod(row.at("r=f0/mg")) - r) < 1e-9)
      theta = std::stod(row.at("theta_rad"));
  }
  ASSERT_GE(theta, 0.0);
  constexpr double kFar = 1e5;
  Scene scene;
  scene.cloth.rows = 44;
  scene.cloth.columns = 4;
  scene.cloth.lumping = Lumping::kUniform;
  scene.hang.from = Vec3::Zero();
  scene.hang.to = Vec3(1.0, 0.0, 0.0);
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  const double node_mass = 0.2 * 2.0 * 1.0 / (44.0 * 4.0);
  WindParams wind;
  wind.id = "far";
  wind.position = Vec3(0.5, -kFar, -1.0);
  wind.direction = Vec3::UnitY();
  wind.radius = 10.0;
  wind.node_force = r * node_mass * 9.81 * (1.0 + kFar * kFar);
  scene.wind.push_back(wind);
  Simulator simulator(scene);
  for (int frame = 0; frame < 1200; ++frame) simulator.step();
  const Vec3 tip = simulator.position({43, 1});
  EXPECT_NEAR(tip.y() / 2.0, std::sin(theta), 1e-3);
  EXPECT_NEAR(tip.z() / 2.0, -std::cos(theta), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Ratios, WindEquilibrium, ::testing::Values(0.1, 0.5, 1.0, 2.0));

}  // namespace
}  // namespace curtain
