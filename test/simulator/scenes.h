// SPDX-License-Identifier: BSD-3-Clause
//
// Scenes to try a whole simulator on: the defaults on a given grid, and those that are shipped. And what is asked of
// any.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"

namespace curtain_test {

constexpr double kGravity = 9.81;  // that of every scene which says nothing else [m/s^2]

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

/// The first YAML that a page of the repository shows.
inline std::string exampleOf(const std::string& path) {
  std::ifstream page(std::string(CURTAIN_SOURCE_DIR) + "/" + path);
  std::stringstream whole;
  whole << page.rdbuf();
  const std::string text = whole.str(), fence = "```yaml\n";
  const std::size_t begin = text.find(fence) + fence.size();
  return text.substr(begin, text.find("```", begin) - begin);
}

inline void run(curtain::Simulator& simulator, int frames) {
  for (int frame = 0; frame < frames; ++frame) simulator.step();
}

// Kinetic and potential [J].
inline double energyOf(const curtain::Simulator& simulator) {
  const curtain::Energy energy = simulator.energy();
  return energy.kinetic + energy.potential;
}

// Of the whole cloth [kg].
inline double massOf(const curtain::Simulator& simulator) {
  double mass = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) mass += simulator.mass({i, j});
  }
  return mass;
}

}  // namespace curtain_test
