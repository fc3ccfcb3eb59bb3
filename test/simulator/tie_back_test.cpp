// SPDX-License-Identifier: BSD-3-Clause
//
// Tie-backs: a closed one gathers its row within its radius, an open one lets it go.
#include <gtest/gtest.h>

#include <algorithm>

#include "curtain_sim/simulator.h"
#include "simulator/scenes.h"
#include "simulator/snapshot_testing.h"

namespace curtain {
namespace {

using curtain_test::run;
using curtain_test::shippedScene;

Scene tiedScene(bool closed) {
  Scene scene = shippedScene("tied_curtain");
  scene.contact.self = false;
  scene.tie_back[0].closed = closed;
  return scene;
}

double farthest(const Simulator& simulator) {
  const TieBackParams& loop = simulator.scene().tie_back[0];
  double most = 0.0;
  for (int j = loop.first_column; j <= loop.last_column; ++j)
    most = std::max(most, (simulator.position({loop.row, j}) - loop.point).norm());
  return most;
}

TEST(TieBack, GathersItsRowWithinItsRadius) {
  Simulator simulator(tiedScene(true));
  const TieBackParams& loop = simulator.scene().tie_back[0];
  const double tolerance = simulator.scene().solver.stretch_tolerance;
  double reach = farthest(simulator);
  for (int frame = 0; frame < 300; ++frame) {
    simulator.step();
    reach = std::max(loop.radius, reach - loop.speed / 60.0);
    ASSERT_LE(farthest(simulator), reach * (1.0 + tolerance)) << "frame " << frame;
  }
  EXPECT_EQ(simulator.statistics().last_resort_substeps, 0);
  EXPECT_LE(simulator.statistics().weft_stretch_max, tolerance);
  EXPECT_TRUE(simulator.tieBackClosed("tie"));
}

TEST(TieBack, OpensAndCloses) {
  Simulator simulator(tiedScene(false));
  run(simulator, 60);
  const double open = farthest(simulator);
  EXPECT_GT(open, 0.5);
  EXPECT_FALSE(simulator.tieBackClosed("tie"));
  ASSERT_TRUE(simulator.setTieBack("tie", true).empty());
  run(simulator, 300);
  EXPECT_LE(farthest(simulator), 0.12 * (1.0 + simulator.scene().solver.stretch_tolerance));
  ASSERT_TRUE(simulator.setTieBack("tie", false).empty());
  run(simulator, 300);
  EXPECT_NEAR(farthest(simulator), open, 0.1 * open);
  simulator.reset();
  EXPECT_FALSE(simulator.tieBackClosed("tie"));
}

TEST(TieBack, SaysWhichThereAre) {
  Simulator simulator(tiedScene(true));
  const std::vector<Problem> problems = simulator.setTieBack("rope", true);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].text.find("tie"), std::string::npos);
  EXPECT_FALSE(simulator.tieBackClosed("rope"));
}

// What closing puts in is counted as the drive's work.
TEST(TieBack, ClosingDoesTheWorkThatRaisesTheCloth) {
  Scene scene = tiedScene(true);
  scene.air = AirParams();
  Simulator simulator(scene);
  const double start = simulator.energy().kinetic + simulator.energy().potential;
  simulator.countWork(true);
  run(simulator, 300);
  const double gained = simulator.energy().kinetic + simulator.energy().potential - start;
  EXPECT_GT(gained, 0.1);
  EXPECT_GE(simulator.work().drive, 0.99 * gained) << "only impacts lose energy";
  EXPECT_LT(simulator.work().drive, 2.0 * gained);
}

TEST(TieBack, SleepsWhenClosedAndWakesWhenOpened) {
  Scene scene = tiedScene(true);
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  Simulator simulator(scene);
  run(simulator, 1200);
  EXPECT_TRUE(simulator.statistics().asleep);
  ASSERT_TRUE(simulator.setTieBack("tie", false).empty());
  run(simulator, 60);
  EXPECT_FALSE(simulator.statistics().asleep);
  EXPECT_GT(farthest(simulator), 0.2);
}

TEST(TieBack, PointsOutOfReachAreNamed) {
  Scene scene = tiedScene(true);
  scene.tie_back[0].point = Vec3(-1.0, 0.0, 1.0);
  EXPECT_THROW(Simulator{scene}, std::invalid_argument);
}

// A loop closing, with a load that swings on the hem.
TEST(TieBack, SnapshotsContinue) {
  Scene scene = tiedScene(true);
  scene.cloth.rows = 12;
  scene.cloth.columns = 15;
  scene.hang.heading = Heading::kGathered;
  scene.tie_back[0].row = 8;
  scene.tie_back[0].last_column = 14;
  LineParams line;
  line.id = "line";
  line.nodes = {{11, 3}, {11, 9}};
  line.mass = 0.05;
  line.to = Vec3(0.5, 0.3, -0.2);
  scene.lines.push_back(line);
  line.id = "guy";
  line.nodes = {{5, 14}};
  line.mass.reset();
  line.to = Vec3(1.5, 0.3, 0.2);
  scene.lines.push_back(line);
  curtain_test::Life life;
  life.deeds = [](Simulator& simulator, int frame) {
    if (frame == 12) simulator.setTieBack("tie", false);
    if (frame == 19) simulator.setTieBack("tie", true);
    if (frame % 3 == 0) simulator.setLineEnd("guy", Vec3(1.5 + 0.002 * frame, 0.3, 0.2));
  };
  curtain_test::expectContinues(scene, life);
}

}  // namespace
}  // namespace curtain
