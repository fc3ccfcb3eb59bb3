// SPDX-License-Identifier: BSD-3-Clause
//
// No step of any method on any of the scenes computes with what is no number, not even in passing. In Debug builds.
#include "float_traps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "curtain_sim/scene_yaml.h"
#include "curtain_sim/simulator.h"

namespace {

namespace fs = std::filesystem;

using curtain::Method;
using curtain::Scene;
using curtain::Simulator;
using curtain_test::FloatTraps;

// Small enough for a build without optimisation.
Scene smaller(Scene scene) {
  scene.cloth.rows = std::min(scene.cloth.rows, 14);
  scene.cloth.columns = std::min(scene.cloth.columns, 12);
  std::vector<curtain::NodeIndex>& pins = scene.pins.nodes;
  for (curtain::NodeIndex& pin : pins) pin.row = std::min(pin.row, scene.cloth.rows - 1);
  const auto gone = [&](const curtain::NodeIndex& pin) { return pin.column >= scene.cloth.columns; };
  pins.erase(std::remove_if(pins.begin(), pins.end(), gone), pins.end());
  scene.solver.threads = 1;  // traps are a thread's own
  return scene;
}

void stepAll(const Scene& scene, double seconds) {
  for (std::size_t m = 0; m < curtain::methodNames().size(); ++m) {
    Scene with = scene;
    with.solver.method = static_cast<Method>(m);
    if (with.solver.method == Method::kPaper && !with.rail.path.empty()) continue;
    SCOPED_TRACE(curtain::methodNames()[m]);
    Simulator simulator(with);
    curtain::FineMesh mesh;
    const FloatTraps traps;
    while (simulator.time() < seconds) simulator.step();
    simulator.copyFineMesh(mesh);
    EXPECT_TRUE(simulator.statistics().finite);
  }
}

class FloatTrapsInSteps : public testing::Test {
 protected:
  void SetUp() override {
#ifndef CURTAIN_FLOAT_TRAPS
    GTEST_SKIP() << "only Debug builds keep traps where they are";
#endif
  }
};

TEST_F(FloatTrapsInSteps, FindNothingInAllScenes) {
  int count = 0;
  for (const char* folder : {"/config/scenes", "/test/scenes"}) {
    for (const auto& entry : fs::directory_iterator(std::string(CURTAIN_SOURCE_DIR) + folder)) {
      if (entry.path().extension() != ".yaml") continue;
      SCOPED_TRACE(entry.path().string());
      const curtain::SceneReading reading = curtain::readSceneFile(entry.path().string());
      ASSERT_TRUE(reading.problems.empty()) << curtain::describe(reading.problems);
      stepAll(smaller(reading.scene), 0.5);
      ++count;
    }
  }
  EXPECT_GE(count, 6);
}

// Where something is nothing: no air, no weight, no friction, nodes in one place, a wind without width.
TEST_F(FloatTrapsInSteps, FindNothingInScenesWithZeros) {
  Scene scene;
  scene.cloth.rows = 6;
  scene.cloth.columns = 5;
  scene.solver.threads = 1;
  scene.hang.to = curtain::Vec3(1e-9, 0.0, 2.2);
  stepAll(scene, 0.2);
  scene.gravity.setZero();
  scene.air.density = 0.0;
  stepAll(scene, 0.2);
  curtain::WindParams wind;
  wind.id = "still";
  scene.wind.push_back(wind);
  wind.id = "narrow";
  wind.radius = 1e-9;
  wind.pressure = 5.0;
  wind.half_angle = 1.5;
  scene.wind.push_back(wind);
  curtain::ObstacleParams box;
  box.name = "box";
  box.shape = curtain::ShapeKind::kBox;
  box.size = curtain::Vec3(1.0, 1.0, 1e-6);
  box.pose.position = curtain::Vec3(0.0, 0.0, 1.0);
  box.friction = 0.0;
  scene.obstacles.push_back(box);
  scene.contact.self = true;
  scene.hang.to = curtain::Vec3(1.0, 0.0, 2.2);
  stepAll(scene, 0.2);
}

}  // namespace
