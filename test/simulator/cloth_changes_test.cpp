// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that becomes another one while it moves goes on as cloth that has been that from the start and is put there: to
// the bit, so nothing of the old one is left anywhere.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <string>

#include "simulator/scenes.h"
#include "testing.h"

namespace curtain_test {
namespace {

using namespace curtain;

using Change = std::function<void(ClothParams&)>;

// Touches itself and a mesh, hangs in wind, is dragged.
Scene clothInTouch() {
  Scene scene = flatScene(12, 10);
  scene.hang.to.x() = 0.8;
  scene.hang.tilt = 0.7;
  scene.contact.self = true;
  ObstacleParams mesh = ballAt({0.4, 0.25, 0.5}, 0.0);
  mesh.name = "mesh";
  mesh.shape = ShapeKind::kMesh;
  mesh.mesh = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/icosphere.stl";
  mesh.scale = Vec3::Constant(0.15);
  scene.obstacles = {mesh};
  WindParams wind;
  wind.id = "fan";
  wind.position = {0.4, -1.0, 0.5};
  wind.direction = Vec3::UnitY();
  wind.pressure = 2.0;
  scene.wind = {wind};
  DragParams drag;
  drag.id = "drag";
  drag.node = NodeIndex{11, 3};
  drag.target = Vec3(0.3, 0.4, 0.4);
  scene.drag = {drag};
  return scene;
}

ClothParams resistingEverything(ClothParams cloth) {
  cloth.bending_warp = cloth.bending_weft = 2e-4;
  cloth.bending_bias = 3e-4;
  cloth.bending_hysteresis = 1e-3;
  cloth.shear = 15.0;
  cloth.porosity = 0.2;
  return cloth;
}

std::map<std::string, Change> changes() {
  return {{"density", [](ClothParams& cloth) { cloth.surface_density = 0.5; }},
          {"porosity", [](ClothParams& cloth) { cloth.porosity = 0.6; }},
          {"row_mass", [](ClothParams& cloth) { cloth.row_mass = {1, 1, 1, 1, 1, 2, 1, 1, 1, 1, 1, 5}; }},
          {"column_mass", [](ClothParams& cloth) { cloth.column_mass = {2, 1, 1, 1, 1, 1, 1, 1, 1, 3}; }},
          {"shear", [](ClothParams& cloth) { cloth.shear = cloth.shear > 0.0 ? 0.0 : 40.0; }},
          {"bending",
           [](ClothParams& cloth) {
             cloth.bending_hysteresis = 0.0;
             cloth.bending_warp = cloth.bending_warp > 0.0 ? 0.0 : 1e-4;
             cloth.bending_weft = cloth.bending_weft > 0.0 ? 5e-4 : 1e-4;
           }},
          {"bias", [](ClothParams& cloth) { cloth.bending_bias = cloth.bending_bias > 0.0 ? 0.0 : 1e-3; }},
          {"patches",
           [](ClothParams& cloth) {
             PatchParams hem, netting;
             hem.rows = {9, 11};
             hem.surface_density = 0.4;
             hem.bending_warp = hem.bending_weft = 2e-4;
             netting.rows = {0, 4};
             netting.columns = {3, 9};
             netting.porosity = 0.7;
             netting.shear = 10.0;
             cloth.patches = {hem, netting};
           }},
          {"all", [](ClothParams& cloth) {
             cloth = resistingEverything(cloth);
             cloth.surface_density = 0.3;
           }}};
}

void putInto(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities, Simulator& simulator) {
  const std::vector<Problem> problems = simulator.setState(positions, velocities);
  EXPECT_TRUE(problems.empty()) << describe(problems);
}

void grasp(Simulator& simulator, double stiffness) {
  GraspParams hand;
  hand.id = "hand";
  hand.frame.position = simulator.position({11, 9});
  hand.radius = 0.12;
  hand.stiffness = stiffness;
  const std::vector<Problem> problems = simulator.setGrasp(hand);
  EXPECT_TRUE(problems.empty()) << describe(problems);
}

TEST(ClothChanges, LeaveNothingOfTheOldCloth) {
  for (const bool relative : {false, true}) {
    for (const bool stiff : {false, true}) {
      for (const auto& [name, change] : changes()) {
        SCOPED_TRACE(name + (stiff ? " of stiff cloth" : " of limp cloth") + (relative ? ", relative air" : ""));
        Scene scene = clothInTouch();
        if (relative) scene.air.law = AirLaw::kRelative;
        if (stiff) scene.cloth = resistingEverything(scene.cloth);
        scene.cloth.bending_hysteresis = 0.0;  // whose sliders remember how the cloth has bent
        Scene other = scene;
        change(other.cloth);
        Simulator changed(scene);
        run(changed, 25);
        std::vector<Vec3> positions, velocities;
        changed.copyPositions(positions);
        changed.copyVelocities(velocities);
        const double time = changed.time();
        const std::vector<Problem> problems = changed.setCloth(other.cloth);
        ASSERT_TRUE(problems.empty()) << describe(problems);
        std::vector<Vec3> after;
        changed.copyPositions(after);
        EXPECT_EQ(positions, after);
        changed.copyVelocities(after);
        EXPECT_EQ(velocities, after);
        EXPECT_EQ(changed.time(), time);
        EXPECT_EQ(changed.statistics().frames, 25);
        Simulator fresh(other);
        putInto(positions, velocities, changed);
        putInto(positions, velocities, fresh);
        grasp(changed, stiff ? 30.0 : std::numeric_limits<double>::infinity());
        grasp(fresh, stiff ? 30.0 : std::numeric_limits<double>::infinity());
        for (int frame = 0; frame < 20; ++frame) {
          changed.step();
          fresh.step();
          ASSERT_EQ(changed.stateHash(), fresh.stateHash()) << "frame " << frame;
        }
        changed.reset();
        fresh.reset();
        EXPECT_EQ(changed.stateHash(), fresh.stateHash());
      }
    }
  }
}

// Hands, drags, winds, moved pins and obstacles, carriers and loads are where they were, and go on.
TEST(ClothChanges, KeepWhatElseThereIs) {
  Scene scene = clothInTouch();
  LineParams line;
  line.id = "line";
  line.nodes = {{11, 0}, {11, 2}};
  line.mass = 0.05;
  line.length = 0.4;
  scene.lines = {line};
  Simulator simulator(scene);
  grasp(simulator, 50.0);
  run(simulator, 20);
  const Pose pose{{0.4, 0.3, 0.5}, Rotation::Identity()};
  simulator.setObstaclePose(0, pose);
  simulator.movePin({0, 0}, Vec3(0.0, 0.05, 1.0));
  const ObstacleShape* const shape = &simulator.obstacleShape(0);
  simulator.countWork(true);
  const Vec3 load = *simulator.lineEnd("line");
  const GraspState held = *simulator.graspState("hand");
  ClothParams cloth = scene.cloth;
  cloth.shear = 20.0;
  ASSERT_TRUE(simulator.setCloth(cloth).empty());
  EXPECT_EQ(*simulator.lineEnd("line"), load);
  EXPECT_EQ(simulator.graspState("hand")->nodes.size(), held.nodes.size());
  EXPECT_EQ(simulator.winds().size(), 1U);
  EXPECT_EQ(&simulator.obstacleShape(0), shape);
  simulator.step();
  EXPECT_EQ(simulator.obstaclePose(0).position, pose.position);
  EXPECT_LT((simulator.position({0, 0}) - Vec3(0.0, 0.05, 1.0)).norm(), 1e-12);
  run(simulator, 60);
  EXPECT_LE(simulator.statistics().weft_stretch, scene.solver.stretch_tolerance);
  EXPECT_EQ(simulator.selfCrossings(), 0);
}

// Counters go on, and what an error estimate has learnt stays.
TEST(ClothChanges, KeepWhatIsCountedAndEstimated) {
  Scene scene = flatScene(10, 8);
  scene.hang.tilt = 0.8;
  scene.solver.position_tolerance = 1e-3;
  Simulator simulator(scene);
  run(simulator, 90);
  const Statistics before = simulator.statistics();
  ClothParams cloth = scene.cloth;
  cloth.surface_density = 0.25;
  cloth.bending_warp = cloth.bending_weft = 1e-4;
  cloth.bending_hysteresis = 1e-3;
  const std::vector<Problem> problems = simulator.setCloth(cloth);
  ASSERT_TRUE(problems.empty()) << describe(problems);
  run(simulator, 1);
  const Statistics& after = simulator.statistics();
  EXPECT_EQ(after.frames, before.frames + 1);
  EXPECT_GE(after.substeps, before.substeps + before.substeps_last / 2) << "as fine as before";
  EXPECT_GE(after.stage_seconds[0], before.stage_seconds[0]);
}

TEST(ClothChanges, GoIntoSnapshots) {
  const Scene scene = clothInTouch();
  Simulator simulator(scene), other(scene);
  run(simulator, 10);
  ASSERT_TRUE(simulator.setCloth(resistingEverything(scene.cloth)).empty());
  run(simulator, 10);
  const std::vector<Problem> problems = other.restore(simulator.snapshot());
  ASSERT_TRUE(problems.empty()) << describe(problems);
  EXPECT_EQ(other.scene().cloth.shear, 15.0);
  run(simulator, 20);
  run(other, 20);
  EXPECT_EQ(other.stateHash(), simulator.stateHash());
}

TEST(ClothChanges, WakeClothAndLetItSleepAgain) {
  Scene scene = flatScene(8, 8);
  scene.hang.to.x() = 0.9;
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  Simulator simulator(scene);
  const auto sleeps = [&] {
    for (int frame = 0; frame < 1200 && !simulator.statistics().asleep; ++frame) simulator.step();
    return simulator.statistics().asleep;
  };
  ASSERT_TRUE(sleeps());
  ASSERT_TRUE(simulator.setCloth(scene.cloth).empty());
  run(simulator, 2);
  EXPECT_TRUE(simulator.statistics().asleep) << "nothing has changed";
  ClothParams heavy = scene.cloth;
  heavy.surface_density = 0.4;
  ASSERT_TRUE(simulator.setCloth(heavy).empty());
  simulator.step();
  EXPECT_FALSE(simulator.statistics().asleep);
  EXPECT_TRUE(sleeps());
  heavy.surface_density = 0.5;
  ASSERT_TRUE(simulator.setCloth(heavy).empty());
  simulator.step();
  EXPECT_EQ(simulator.statistics().wakes, 2);
}

TEST(ClothChanges, AreRefusedInWords) {
  const Scene scene = clothInTouch();
  Simulator simulator(scene);
  const auto refused = [&](const Change& change, const std::string& key, const std::string& text) {
    ClothParams cloth = scene.cloth;
    change(cloth);
    const std::vector<Problem> problems = simulator.setCloth(cloth);
    ASSERT_EQ(problems.size(), 1U) << key;
    EXPECT_EQ(problems[0].key, key);
    EXPECT_NE(problems[0].text.find(text), std::string::npos) << problems[0].text;
  };
  refused([](ClothParams& cloth) { cloth.rows = 13; }, "cloth.rows",
          "can't change while it runs: is 13 there, 12 here");
  refused([](ClothParams& cloth) { cloth.height = 2.0; }, "cloth.height", "can't change while it runs");
  refused([](ClothParams& cloth) { cloth.shear = -1.0; }, "cloth.shear", "is -1");
  refused([](ClothParams& cloth) { cloth.row_mass = {1.0}; }, "cloth.row_mass", "12");
  run(simulator, 1);
  Simulator same(scene);
  run(same, 1);
  EXPECT_EQ(simulator.stateHash(), same.stateHash());
}

}  // namespace
}  // namespace curtain_test
