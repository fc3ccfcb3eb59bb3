// SPDX-License-Identifier: BSD-3-Clause
//
// Chains as cloth: N rods of 2 m in all released straight, side by side in columns that know nothing of each other, and
// how far such a cloth is off the exact motion (test/truth/traj_N*_A*.csv).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"
#include "testing.h"
#include "truth_table.h"

namespace curtain_test {

constexpr int kChainColumns = 8;

/// The scene swing with N rods released at so many degrees from the vertical. Its columns pull at each other in no way,
/// so that 8 of them (a block of the rods' solver) tell what 40 do.
inline curtain::Scene chainScene(int rods, double degrees = 45.0, int columns = kChainColumns) {
  curtain::Scene scene = curtain::readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/test/scenes/swing.yaml").scene;
  scene.cloth.rows = rods + 1;
  scene.cloth.columns = columns;
  scene.hang.tilt = degrees * kPi / 180.0;
  return scene;
}

struct ChainError {
  double position = 0.0;  ///< RMS over the free nodes [m]
  double velocity = 0.0;  ///< the same [m/s]
};

/// Every row of a table of the truth by its time, read once.
inline const std::vector<TruthRow>& chainTruth(int rods, int degrees) {
  static std::map<std::string, std::vector<TruthRow>> tables;
  const std::string name = "traj_N" + std::to_string(rods) + "_A" + std::to_string(degrees) + ".csv";
  std::vector<TruthRow>& table = tables[name];
  if (table.empty()) table = readTruth(name);
  return table;
}

/// Of a chain scene's present state; its time must be one of the truth's, a multiple of 0.05 s. The cloth turns towards
/// -y, the truth's chain towards +x.
inline ChainError chainError(const curtain::Simulator& simulator, int degrees) {
  const int rods = simulator.rows() - 1;
  const int columns = simulator.columns();
  const TruthRow& row =
      chainTruth(rods, degrees).at(static_cast<std::size_t>(std::lround(simulator.time() / 0.05)) - 1);
  EXPECT_NEAR(std::stod(row.at("t")), simulator.time(), 1e-9);
  std::vector<curtain::Vec3> x, v;
  simulator.copyPositions(x);
  simulator.copyVelocities(v);
  ChainError error;
  for (int i = 1; i <= rods; ++i) {
    const std::string k = std::to_string(i);
    const curtain::Vec3 x_true(0.0, -std::stod(row.at("x" + k)), std::stod(row.at("y" + k)));
    const curtain::Vec3 v_true(0.0, -std::stod(row.at("vx" + k)), std::stod(row.at("vy" + k)));
    for (int j = 0; j < columns; ++j) {
      const auto n = static_cast<std::size_t>(i * columns + j);
      curtain::Vec3 off = x[n] - x_true;
      off.x() = 0.0;  // along the hung edge; the columns' own places
      error.position += off.squaredNorm();
      error.velocity += (v[n] - v_true).squaredNorm();
    }
  }
  const double samples = static_cast<double>(rods) * columns;
  error.position = std::sqrt(error.position / samples);
  error.velocity = std::sqrt(error.velocity / samples);
  return error;
}

inline void makeFrames(curtain::Simulator& simulator, int frames) {
  for (int frame = 0; frame < frames; ++frame) simulator.step();
}

/// The error after a second of a chain in so many fixed substeps (0: the method's own).
inline ChainError chainErrorAfterASecond(curtain::Scene scene, curtain::Method method, int substeps, int degrees = 45) {
  scene.solver.method = method;
  scene.solver.substeps = substeps;
  curtain::Simulator simulator(scene);
  makeFrames(simulator, static_cast<int>(std::lround(scene.solver.frame_rate)));
  return chainError(simulator, degrees);
}

}  // namespace curtain_test
