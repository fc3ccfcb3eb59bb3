// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes to try a whole simulator on: the defaults on a given grid, and those that are shipped.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"

namespace curtain_test {

inline curtain::Scene sceneOf(int rows, int columns) {
  curtain::Scene scene;
  scene.cloth.rows = rows;
  scene.cloth.columns = columns;
  return scene;
}

inline curtain::Scene shippedScene(const std::string& name) {
  const curtain::SceneReading reading =
      curtain::readSceneFile(std::string(CURTAIN_SOURCE_DIR) + "/config/scenes/" + name + ".yaml");
  EXPECT_TRUE(reading.problems.empty()) << curtain::describe(reading.problems);
  return reading.scene;
}

inline void run(curtain::Simulator& simulator, int frames) {
  for (int frame = 0; frame < frames; ++frame) simulator.step();
}

}  // namespace curtain_test
