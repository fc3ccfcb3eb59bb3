// SPDX-License-Identifier: BSD-3-Clause
//
// Finger pads that close on cloth hold it by friction alone: up to 2 mu N, with which they carry it wherever they go;
// they feel its weight and each other; opened, they let go.
#include <gtest/gtest.h>

#include <cmath>

#include "curtain_sim/simulator.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;

constexpr double kG = 9.81, kMu = 0.5, kThickness = 0.001, kHalfPad = 0.01;

ObstacleParams pad(const std::string& name, double side, double press) {
  ObstacleParams box;
  box.name = name;
  box.shape = ShapeKind::kBox;
  box.size = {0.2, 2.0 * kHalfPad, 0.04};
  box.pose.position = {0.07, side * (kHalfPad + kThickness), 0.27};
  box.press = press;
  return box;
}

// A strip of 14 x 30 cm that nothing holds but two pads near its upper edge, closed on it from the start. weight: its
// own, over what the pads can hold, 2 mu N.
Scene pinchedScene(double weight, double press = 1.0) {
  Scene scene = flatScene(16, 8, 0.3, 0.14);
  scene.pins.kind = PinKind::kNone;
  scene.cloth.surface_density = weight * 2.0 * kMu * press / kG / (0.3 * 0.14);
  scene.contact.thickness = kThickness;
  scene.contact.friction = kMu;
  scene.obstacles = {pad("left", -1.0, press), pad("right", 1.0, press)};
  return scene;
}

double meanHeight(const Simulator& simulator) {
  double sum = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) sum += simulator.mass({i, j}) * simulator.position({i, j}).z();
  }
  return sum;
}
double mass(const Simulator& simulator) {
  double sum = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) sum += simulator.mass({i, j});
  }
  return sum;
}
// By how much the cloth's centre has sunk [m].
double sunk(double weight, double press, double seconds) {
  Simulator simulator(pinchedScene(weight, press));
  const double before = meanHeight(simulator) / mass(simulator);
  curtain_test::run(simulator, static_cast<int>(std::lround(60.0 * seconds)));
  return before - meanHeight(simulator) / mass(simulator);
}

// 2 mu N is what they hold: five percent less stays, up to the links' tolerance of 1e-3 over 0.3 m of cloth; five
// percent more slides, with the acceleration that is left.
TEST(Pads, HoldTwiceMuN) {
  for (const double press : {0.2, 1.0, 5.0}) {
    EXPECT_LT(sunk(0.95, press, 2.0), 1e-3 * 0.3) << press;
    const double time = 0.2, fall = 0.5 * kG * (1.0 - 1.0 / 1.05) * time * time;
    EXPECT_NEAR(sunk(1.05, press, time), fall, 0.1 * fall) << press;
  }
}

TEST(Pads, FeelTheWeightAndEachOther) {
  const double press = 1.0;
  Simulator simulator(pinchedScene(0.8, press));
  curtain_test::run(simulator, 120);
  const double weight = kG * mass(simulator);
  const ContactWrench left = simulator.contactWrench(0), right = simulator.contactWrench(1);
  EXPECT_NEAR(left.force.z() + right.force.z(), -weight, 1e-3 * weight);
  EXPECT_NEAR(left.force.y(), -press, 1e-2 * press);
  EXPECT_NEAR(right.force.y(), press, 1e-2 * press);
  EXPECT_EQ(simulator.piercings(0).nodes + simulator.piercings(1).nodes, 0);
}

// They carry the cloth along, at up to 1.8 m/s^2, for which 2 mu N suffice twice; when they have opened, it falls
// freely.
TEST(Pads, CarryAndLetGo) {
  Simulator simulator(pinchedScene(0.5));
  const auto move = [&simulator](double up, double apart) {
    for (int k = 0; k < 2; ++k) {
      Pose pose = simulator.scene().obstacles[static_cast<std::size_t>(k)].pose;
      pose.position += Vec3(0.0, (k == 0 ? -1.0 : 1.0) * apart, up);
      simulator.setObstaclePose(k, pose);
    }
    simulator.step();
  };
  const double before = meanHeight(simulator) / mass(simulator);
  for (int frame = 1; frame <= 60; ++frame) {
    const double t = frame / 60.0;
    move(0.3 * t * t * (3.0 - 2.0 * t), 0.0);
  }
  for (int frame = 0; frame < 30; ++frame) move(0.3, 0.0);
  EXPECT_NEAR(meanHeight(simulator) / mass(simulator) - before, 0.3, 1e-3 * 0.3);
  for (int frame = 1; frame <= 6; ++frame) move(0.3, 0.002 * frame);  // faster than the thickness a frame
  const double open = meanHeight(simulator) / mass(simulator);
  for (int frame = 0; frame < 15; ++frame) move(0.3, 0.012);
  EXPECT_LT(meanHeight(simulator) / mass(simulator) - open, -0.9 * 0.5 * kG * 0.25 * 0.25);
}

TEST(Pads, AreKeptInSnapshots) {
  const Scene scene = pinchedScene(1.02);
  Simulator through(scene), restored(scene);
  curtain_test::run(through, 20);
  ASSERT_TRUE(restored.restore(through.snapshot()).empty());
  for (Simulator* one : {&through, &restored}) curtain_test::run(*one, 30);
  EXPECT_EQ(through.stateHash(), restored.stateHash());
}

// One pad alone, or two that press nothing, hold what obstacles without the key hold: nothing.
TEST(Pads, NeedEachOther) {
  for (const bool alone : {true, false}) {
    Scene scene = pinchedScene(0.5);
    scene.obstacles[0].press = 0.0;
    if (!alone) scene.obstacles[1].press = 0.0;
    Simulator simulator(scene);
    const double before = meanHeight(simulator) / mass(simulator);
    curtain_test::run(simulator, 12);
    EXPECT_NEAR(before - meanHeight(simulator) / mass(simulator), 0.5 * kG * 0.2 * 0.2, 0.02 * 0.5 * kG * 0.2 * 0.2);
  }
}

}  // namespace
}  // namespace curtain
