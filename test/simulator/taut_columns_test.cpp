// SPDX-License-Identifier: BSD-3-Clause
//
// A column that is straight between two pins can't move but with them; one with slack hangs as ever.
#include <gtest/gtest.h>

#include <cmath>

#include "curtain_sim/simulator.h"
#include "rail_scenes.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;

constexpr int kRows = 11;

// Its first column is pinned at both ends, 1 m apart, as far as it is long.
Scene pinnedColumn() {
  Scene scene = flatScene(kRows, 6, 1.0, 0.5);
  scene.pins.kind = PinKind::kList;
  scene.pins.nodes = {{0, 0}, {kRows - 1, 0}};
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  return scene;
}

// How far the nodes between are from the line between the pins [m].
double bulge(const Simulator& simulator) {
  const Vec3 from = simulator.position({0, 0}), to = simulator.position({kRows - 1, 0});
  double most = 0.0;
  for (int row = 1; row < kRows - 1; ++row) {
    const Vec3 there = from + static_cast<double>(row) / (kRows - 1) * (to - from);
    most = std::max(most, (simulator.position({row, 0}) - there).norm());
  }
  return most;
}

TEST(TautColumns, MoveWithTheirPins) {
  Simulator simulator(pinnedColumn());
  const Vec3 top = simulator.position({0, 0}), foot = simulator.position({kRows - 1, 0});
  for (int frame = 1; frame <= 120; ++frame) {
    // Both by 0.3 m, and the foot around the top.
    const Vec3 shift(0.0, 0.3 * frame / 120.0, 0.0);
    const Eigen::AngleAxisd turn(0.5 * frame / 120.0, Vec3::UnitY());
    ASSERT_TRUE(simulator.movePin({0, 0}, top + shift));
    ASSERT_TRUE(simulator.movePin({kRows - 1, 0}, top + shift + turn * (foot - top)));
    simulator.step();
    ASSERT_LT(bulge(simulator), 1e-4) << frame;  // a chord for an arc of a frame
  }
  EXPECT_EQ(simulator.statistics().last_resort_substeps, 0);
  EXPECT_FALSE(simulator.pinned({5, 0}));
  EXPECT_LT(simulator.statistics().warp_stretch, simulator.scene().solver.stretch_tolerance);
}

// With its ends 2 cm nearer it sags, by about the half of sqrt(0.02 m * 1 m); drawn straight again it is held again.
TEST(TautColumns, AreFreeWhenTheyAreSlack) {
  Scene scene = pinnedColumn();
  scene.hang.tilt = 0.5 * curtain_test::kPi;  // flat, so that it sags
  Simulator simulator(scene);
  const Vec3 foot = simulator.position({kRows - 1, 0}), top = simulator.position({0, 0});
  for (int frame = 0; frame < 30; ++frame) simulator.step();
  EXPECT_LT(bulge(simulator), 1e-12);
  const auto go = [&](const Vec3& to) {
    const Vec3 from = simulator.position({kRows - 1, 0});
    for (int frame = 1; frame <= 30; ++frame) {
      simulator.movePin({kRows - 1, 0}, from + frame / 30.0 * (to - from));
      simulator.step();
    }
    for (int frame = 0; frame < 120; ++frame) simulator.step();
  };
  go(foot + 0.02 * (top - foot));
  EXPECT_GT(bulge(simulator), 0.04);
  Simulator restored(scene);
  ASSERT_TRUE(restored.restore(simulator.snapshot()).empty());
  go(foot);
  EXPECT_LT(bulge(simulator), 0.03);  // within the tolerance of its links
  EXPECT_GT(bulge(restored), 0.04);
}

// A curtain on a rail, pinned below two of its carriers, as far below as it is long: neither its columns nor those
// carriers can move, however the others are drawn.
Scene pinnedBelowCarriers() {
  Scene scene = curtain_test::railScene(kRows, 7, 3, 0.6, 1.0);
  scene.pins.kind = PinKind::kList;
  scene.pins.nodes = {{kRows - 1, 0}, {kRows - 1, 3}};
  scene.air.inside = scene.air.border = scene.air.corner = 1.0;
  return scene;
}

TEST(TautColumns, HoldTheCarriersTheyHangFrom) {
  Simulator simulator(pinnedBelowCarriers());
  const Vec3 held = simulator.position({0, 3});
  const double free = curtain_test::carrierX(simulator, 6);
  simulator.setOpening(1.0);
  for (int frame = 0; frame < 240; ++frame) {
    simulator.step();
    ASSERT_EQ(simulator.position({0, 3}), held) << frame;
    ASSERT_LT(bulge(simulator), 1e-12) << frame;
    curtain_test::expectOnRail(simulator);
  }
  EXPECT_GT(std::abs(curtain_test::carrierX(simulator, 6) - free), 0.05);
  EXPECT_EQ(simulator.statistics().last_resort_substeps, 0);
}

// A pin that moves along the rail takes the carrier along, and one that rises lets the column sag.
TEST(TautColumns, LetCarriersGoWithTheirPins) {
  Scene scene = pinnedBelowCarriers();
  scene.pins.nodes = {{kRows - 1, 6}};
  scene.rail.carriers.friction = 0.0;
  Simulator simulator(scene);
  const Vec3 foot = simulator.position({kRows - 1, 6});
  const double before = curtain_test::carrierX(simulator, 6);
  for (int frame = 1; frame <= 120; ++frame) {
    ASSERT_TRUE(simulator.movePin({kRows - 1, 6}, foot + Vec3(-0.2 * frame / 120.0, 0.0, 0.1 * frame / 120.0)));
    simulator.step();
  }
  EXPECT_LT(curtain_test::carrierX(simulator, 6), before - 0.05);
  EXPECT_LT(simulator.statistics().warp_stretch, 2.0 * scene.solver.stretch_tolerance);
}

// Snapshots of held columns go on to the same bits.
TEST(TautColumns, AreKeptInSnapshots) {
  Simulator simulator(pinnedColumn());
  for (int frame = 0; frame < 10; ++frame) simulator.step();
  Simulator restored(pinnedColumn());
  ASSERT_TRUE(restored.restore(simulator.snapshot()).empty());
  for (int frame = 0; frame < 30; ++frame) {
    simulator.step();
    restored.step();
  }
  EXPECT_EQ(restored.stateHash(), simulator.stateHash());
}

// A node that is put beside the line is not held there: its rods bring it back.
TEST(TautColumns, AreNotHeldBesideTheirLine) {
  Simulator simulator(pinnedColumn());
  std::vector<Vec3> positions;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < 6; ++column) positions.push_back(simulator.position({row, column}));
  }
  const std::vector<Vec3> velocities(positions.size(), Vec3::Zero());
  positions[5 * 6].y() += 0.05;
  ASSERT_TRUE(simulator.setState(positions, velocities).empty());
  ASSERT_GT(bulge(simulator), 0.04);
  for (int frame = 0; frame < 60; ++frame) simulator.step();
  EXPECT_LT(bulge(simulator), 0.02);
  EXPECT_LT(simulator.statistics().warp_stretch, 2.0 * simulator.scene().solver.stretch_tolerance);
}

}  // namespace
}  // namespace curtain
