// SPDX-License-Identifier: BSD-3-Clause
//
// Keys of the scene that may change between frames: friction, tolerances, budget. What is set holds as if the scene had
// said so from then on, survives reset() and comes with snapshots; what is wrong changes nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "curtain_sim/simulator.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain_test {
namespace {

using namespace curtain;

// Touches itself and a ball, and carries a load: the tolerance reaches every part of the solver.
Scene touchingScene() {
  Scene scene = flatScene(10, 8);
  scene.hang.to.x() = 0.6;
  scene.hang.tilt = 0.9;
  scene.contact.self = true;
  scene.obstacles = {ballAt({0.3, 0.25, 0.5}, 0.2)};
  LineParams line;
  line.id = "line";
  line.nodes = {{9, 0}, {9, 7}};
  line.length = 0.8;
  line.mass = 0.1;
  scene.lines = {line};
  return scene;
}

// Kept by an error estimate.
Scene estimatedScene() {
  Scene scene = flatScene(8, 6);
  scene.hang.tilt = 0.8;
  scene.solver.position_tolerance = 1e-3;
  return scene;
}

struct Key {
  Scene scene;
  std::function<void(Scene&)> in_scene;
  std::function<std::vector<Problem>(Simulator&)> set;
};

std::map<std::string, Key> keys() {
  return {{"friction",
           {touchingScene(), [](Scene& scene) { scene.contact.friction = 0.9; },
            [](Simulator& simulator) { return simulator.setFriction(0.9); }}},
          {"stretch_tolerance",
           {touchingScene(), [](Scene& scene) { scene.solver.stretch_tolerance = 1e-5; },
            [](Simulator& simulator) { return simulator.setStretchTolerance(1e-5); }}},
          {"position_tolerance",
           {estimatedScene(), [](Scene& scene) { scene.solver.position_tolerance = 1e-5; },
            [](Simulator& simulator) { return simulator.setPositionTolerance(1e-5); }}}};
}

}  // namespace

// No cache keeps the old value: the motion is that of a scene with the new one, to the bit, from the start and after a
// reset.
TEST(LiveKeys, HoldAsIfTheSceneHadSaidSo) {
  for (auto& [name, key] : keys()) {
    SCOPED_TRACE(name);
    Simulator plain(key.scene);
    run(plain, 90);
    Simulator set_first(key.scene);
    ASSERT_TRUE(key.set(set_first).empty());
    Simulator set_later(key.scene);
    run(set_later, 40);
    ASSERT_TRUE(key.set(set_later).empty());
    run(set_later, 20);
    set_later.reset();
    Scene scene = key.scene;
    key.in_scene(scene);
    Simulator expected(scene);
    for (Simulator* simulator : {&set_first, &set_later, &expected}) run(*simulator, 90);
    EXPECT_NE(expected.stateHash(), plain.stateHash()) << "the key matters here";
    EXPECT_EQ(set_first.stateHash(), expected.stateHash());
    EXPECT_EQ(set_later.stateHash(), expected.stateHash());
  }
}

// They are the snapshot's, whatever the scene says that goes on from it.
TEST(LiveKeys, ComeWithSnapshots) {
  for (auto& [name, key] : keys()) {
    SCOPED_TRACE(name);
    Simulator one(key.scene);
    run(one, 30);
    ASSERT_TRUE(key.set(one).empty());
    ASSERT_TRUE(one.setBudget(1e5).empty());  // far more than it needs: it changes no bit
    run(one, 10);
    Simulator other(key.scene);
    run(other, 5);
    const std::vector<Problem> problems = other.restore(one.snapshot());
    ASSERT_TRUE(problems.empty()) << describe(problems);
    run(one, 40);
    run(other, 40);
    EXPECT_EQ(other.stateHash(), one.stateHash());
    EXPECT_EQ(other.scene().contact.friction, one.scene().contact.friction);
    EXPECT_EQ(other.scene().solver.stretch_tolerance, one.scene().solver.stretch_tolerance);
    EXPECT_EQ(other.scene().solver.position_tolerance, one.scene().solver.position_tolerance);
    EXPECT_EQ(other.scene().solver.budget_ms, 1e5);
  }
}

// An estimate is a part of snapshots: one side without it is another scene, and says so.
TEST(LiveKeys, PositionToleranceOnOneSideIsAnotherScene) {
  Scene without = estimatedScene();
  without.solver.position_tolerance = 0.0;
  Simulator a(estimatedScene()), b(without);
  EXPECT_EQ(describe(b.restore(a.snapshot())),
            "solver.position_tolerance: is asked for there, not here: the snapshot is of another scene");
  EXPECT_EQ(describe(a.restore(b.snapshot())),
            "solver.position_tolerance: is asked for here, not there: the snapshot is of another scene");
}

TEST(LiveKeys, OutOfRangeChangeNothing) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  using Set = std::vector<Problem> (Simulator::*)(double);
  const std::vector<std::tuple<std::string, Set, std::vector<double>>> all = {
      {"contact.friction", &Simulator::setFriction, {-0.1, 10.1, nan}},
      {"solver.stretch_tolerance", &Simulator::setStretchTolerance, {0.0, -1e-3, 0.2, nan}},
      {"solver.position_tolerance", &Simulator::setPositionTolerance, {0.0, -1.0, 1.5, nan}},
      {"solver.budget_ms", &Simulator::setBudget, {-1.0, 2e6, nan}}};
  Simulator simulator(estimatedScene());
  run(simulator, 10);
  const std::string before = simulator.snapshot();
  for (const auto& [key, set, values] : all) {
    for (const double value : values) {
      const std::vector<Problem> problems = (simulator.*set)(value);
      ASSERT_EQ(problems.size(), 1U) << key << ' ' << value;
      EXPECT_EQ(problems[0].key, key);
    }
  }
  EXPECT_EQ(simulator.snapshot(), before);
  Simulator without(flatScene(6, 5));
  EXPECT_EQ(describe(without.setPositionTolerance(1e-3)),
            "solver.position_tolerance: must stay 0: the scene asks for none");
}

// Links that a loose tolerance has let get longer are within a strict one after a frame, and stay so.
TEST(LiveKeys, AStricterToleranceHoldsAFrameLater) {
  Scene scene = touchingScene();
  scene.solver.stretch_tolerance = 0.1;
  const double strict = 1e-4;
  Simulator simulator(scene);
  const Statistics& now = simulator.statistics();
  while (std::max(now.warp_stretch, now.weft_stretch) <= strict && now.frames < 300) simulator.step();
  ASSERT_GT(std::max(now.warp_stretch, now.weft_stretch), strict) << "there is something to correct";
  ASSERT_TRUE(simulator.setStretchTolerance(strict).empty());
  for (int frame = 0; frame < 60; ++frame) {
    simulator.step();
    ASSERT_LE(std::max(now.warp_stretch, now.weft_stretch), strict) << frame;
  }
  EXPECT_EQ(simulator.statistics().stops, 0);
}

// A sheet that sleeps on an incline by friction slides when that is lowered: with g (sin a - mu cos a).
TEST(LiveKeys, LowerFrictionWakesWhatItHeld) {
  const double angle = 0.3, friction = 0.1;
  Scene scene;
  scene.cloth.rows = scene.cloth.columns = 8;
  scene.cloth.height = scene.cloth.width = 0.5;
  scene.pins.kind = PinKind::kNone;
  scene.contact.friction = 0.6;  // holds up to 0.54
  const Rotation lean(Eigen::AngleAxisd(angle, Vec3::UnitX()));
  scene.hang.tilt = 0.5 * kPi - angle;
  scene.hang.from = lean * Vec3(0.0, 0.0, scene.contact.thickness);
  scene.hang.to = scene.hang.from + Vec3(0.5, 0.0, 0.0);
  ObstacleParams plane;
  plane.name = "incline";
  plane.shape = ShapeKind::kPlane;
  plane.pose.orientation = lean;
  scene.obstacles = {plane};
  ObstacleParams own = ballAt({0.0, 0.0, -5.0}, 0.1);  // one that names its friction keeps it
  own.friction = 0.7;
  scene.obstacles.push_back(own);
  Simulator simulator(scene);
  while (!simulator.statistics().asleep && simulator.time() < 10.0) simulator.step();
  ASSERT_TRUE(simulator.statistics().asleep);
  const Vec3 start = simulator.position({4, 4});
  ASSERT_TRUE(simulator.setFriction(friction).empty());
  run(simulator, 60);
  const double slid = (simulator.position({4, 4}) - start).norm();
  // Within what test/simulator/obstacles_test.cpp derives for a start from rest.
  EXPECT_NEAR(slid, 0.5 * 9.81 * (std::sin(angle) - friction * std::cos(angle)), 0.02 * 0.5 * 9.81 * std::sin(angle));
  EXPECT_EQ(simulator.scene().obstacles[1].friction, 0.7);
}

// A budget that nothing can keep shortens frames from the next one on; without it they are whole again.
TEST(LiveKeys, ABudgetComesAndGoes) {
  Scene scene = touchingScene();
  Simulator simulator(scene);
  run(simulator, 30);
  ASSERT_EQ(simulator.statistics().shortened_frames, 0);
  ASSERT_TRUE(simulator.setBudget(1e-5).empty());
  run(simulator, 20);
  EXPECT_GT(simulator.statistics().shortened_frames, 0);
  ASSERT_TRUE(simulator.setBudget(0.0).empty());
  const Statistics before = simulator.statistics();
  run(simulator, 60);
  const Statistics& after = simulator.statistics();
  EXPECT_EQ(after.shortened_frames, before.shortened_frames);
  EXPECT_EQ(after.longer_substeps, before.longer_substeps);
  EXPECT_EQ(after.late_frames, before.late_frames);
  EXPECT_EQ(after.lost_time, before.lost_time);
}

}  // namespace curtain_test
