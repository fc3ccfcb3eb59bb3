// SPDX-License-Identifier: BSD-3-Clause
//
// What the simulator says it does is what it does.
#include "curtain_sim/plan.h"

#include <gtest/gtest.h>

#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;

const PlanEntry& entryOf(const Plan& plan, const std::string& stage) {
  for (const PlanEntry& entry : plan) {
    if (entry.stage == stage) return entry;
  }
  static const PlanEntry none{"none", false, "there is no such stage"};
  ADD_FAILURE() << "no stage " << stage << " in\n" << describe(plan);
  return none;
}

WindParams fanCalled(const std::string& id, const Vec3& position) {
  WindParams wind;
  wind.id = id;
  wind.position = position;
  wind.direction = Vec3::UnitY();
  wind.pressure = 2.0;
  return wind;
}

ObstacleParams ballAt(const std::string& name, const Vec3& position) {
  ObstacleParams ball;
  ball.name = name;
  ball.radius = 0.2;
  ball.pose.position = position;
  return ball;
}

TEST(Plan, GravityAloneLeavesEverythingElseOut) {
  const Simulator simulator(flatScene(8, 6));
  const Plan plan = simulator.plan();
  EXPECT_TRUE(entryOf(plan, "warp").runs);
  for (const char* const stage :
       {"normals", "air damping", "force field", "estimate", "budget", "obstacles", "self-contact"}) {
    EXPECT_FALSE(entryOf(plan, stage).runs) << stage;
  }
}

TEST(Plan, NamesWhatActsAndWhyTheOthersDoNot) {
  Scene scene = flatScene(8, 6);
  scene.wind = {fanCalled("near", {0.5, -1.0, 0.5}), fanCalled("past", {9.0, -1.0, 0.5}),
                fanCalled("late", {0.5, -1.0, 0.5}), fanCalled("still", {0.5, -1.0, 0.5})};
  scene.wind[2].start = 7.0;
  scene.wind[3].pressure = 0.0;
  scene.drag.resize(1);
  scene.drag[0].id = "hand";
  scene.drag[0].node = NodeIndex{7, 3};
  scene.drag[0].end = 0.01;
  scene.obstacles = {ballAt("near", {0.5, 0.1, 0.5}), ballAt("far", {5.0, 0.1, 0.5}), ballAt("gone", {0.5, 0.1, 0.5})};
  scene.contact.self = true;
  scene.air.inside = 0.5;
  scene.solver.position_tolerance = 1e-3;
  scene.solver.budget_ms = 1e4;
  Simulator simulator(scene);
  simulator.setObstaclePresent(2, false);
  const Plan at_start = simulator.plan();
  for (const char* const stage : {"wind 'near'", "normals", "air damping", "force field", "drag 'hand'",
                                  "obstacle 'near'", "self-contact", "estimate", "budget"}) {
    EXPECT_TRUE(entryOf(at_start, stage).runs) << stage;
  }
  EXPECT_EQ(entryOf(at_start, "wind 'past'").why, "reaches nothing of the cloth");
  EXPECT_EQ(entryOf(at_start, "wind 'late'").why, "begins at 7 s");
  EXPECT_EQ(entryOf(at_start, "wind 'still'").why, "has no pressure");
  EXPECT_EQ(entryOf(at_start, "obstacle 'gone'").why, "absent");
  for (const char* const stage : {"wind 'past'", "wind 'late'", "wind 'still'", "obstacle 'far'", "obstacle 'gone'"}) {
    EXPECT_FALSE(entryOf(at_start, stage).runs) << stage;
  }
  simulator.step();
  const Plan later = simulator.plan();
  EXPECT_FALSE(entryOf(later, "drag 'hand'").runs);
  EXPECT_EQ(entryOf(later, "drag 'hand'").why, "ended at 0.01 s");
  EXPECT_FALSE(later == at_start);
}

TEST(Plan, OfClothThatSleepsNothingRuns) {
  Scene scene = flatScene(8, 6);
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  Simulator simulator(scene);
  for (int frame = 0; frame < 120; ++frame) simulator.step();
  ASSERT_TRUE(simulator.statistics().asleep);
  for (const PlanEntry& entry : simulator.plan()) EXPECT_EQ(entry.runs, entry.stage == "rest") << entry.stage;
  EXPECT_NE(describe(simulator.plan()).find("+ rest: the cloth sleeps"), std::string::npos);
}

TEST(Plan, GustsAloneReadNoNormals) {
  Scene scene = flatScene(8, 6);
  scene.wind = {fanCalled("gusts", {0.5, -1.0, 0.5})};
  scene.wind[0].pressure = 0.0;
  scene.wind[0].unsteadiness = 1.0;
  const Simulator simulator(scene);
  EXPECT_TRUE(entryOf(simulator.plan(), "wind 'gusts'").runs);
  EXPECT_FALSE(entryOf(simulator.plan(), "normals").runs);
}

}  // namespace
}  // namespace curtain
