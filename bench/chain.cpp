// SPDX-License-Identifier: BSD-3-Clause
#include "bench/chain.h"

#include <cmath>

#include "curtain_sim/scene_yaml.h"
#include "truth_table.h"

namespace curtain_bench {

curtain::Scene chainScene(int rods, double angle) {
  const auto reading = curtain::readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/test/scenes/swing.yaml");
  if (!reading.problems.empty()) throw std::runtime_error(curtain::describe(reading.problems));
  curtain::Scene scene = reading.scene;
  scene.cloth.rows = rods + 1;
  scene.hang.tilt = angle;
  return scene;
}

// The truth's chain turns towards +x with y up, the cloth towards -y with z up; columns keep their places along x.
Points chainTruth(const ClothStart& start, int degrees, double time) {
  const int rods = start.rows - 1;
  const auto table = curtain_test::readTruth("traj_N" + std::to_string(rods) + "_A" + std::to_string(degrees) + ".csv");
  for (const auto& row : table) {
    if (std::abs(std::stod(row.at("t")) - time) > 1e-9) continue;
    Points truth = start.positions;
    for (int i = 1; i <= rods; ++i) {
      const double x = std::stod(row.at("x" + std::to_string(i))), y = std::stod(row.at("y" + std::to_string(i)));
      for (int j = 0; j < start.columns; ++j) {
        const auto n = static_cast<std::size_t>(i * start.columns + j);
        truth.y[n] = -x;
        truth.z[n] = y;
      }
    }
    return truth;
  }
  throw std::runtime_error("the truth has no such time");
}

}  // namespace curtain_bench
