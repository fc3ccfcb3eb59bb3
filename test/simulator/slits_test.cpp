// SPDX-License-Identifier: BSD-3-Clause
//
// Slits: the strips of cut cloth move as if each were alone, touch each other as any cloth does, and no surface, wind
// or normal reaches across a cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "cloth/cloth.h"
#include "curtain_sim/fine_mesh.h"
#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;

constexpr double kLink = 0.05;  // [m]

// Links of kLink both ways.
Scene sheet(int rows, int columns) {
  Scene scene = flatScene(rows, columns, kLink * (rows - 1), kLink * (columns - 1));
  scene.solver.rest_speed = 0.0;
  return scene;
}

WindParams draught() {
  WindParams wind;
  wind.id = "draught";
  wind.position = {0.3, -1.0, 0.5};
  wind.direction = Vec3::UnitY();
  wind.radius = 3.0;
  wind.pressure = 2.0;
  return wind;
}

TEST(Slits, LeaveEachStripTheMassAndAreaThatItHasAlone) {
  Scene scene = sheet(9, 12);
  scene.cloth.slits = {{4, 0}};
  const ClothPattern cut = makePattern(scene), left = makePattern(sheet(9, 5)), right = makePattern(sheet(9, 7));
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 12; ++j) {
      const ClothPattern& alone = j < 5 ? left : right;
      const std::size_t n = cut.grid.index(i, j), m = alone.grid.index(i, j < 5 ? j : j - 5);
      // Lengths are shares of other widths: a few roundings.
      EXPECT_NEAR(cut.area[n], alone.area[m], 16.0 * kEps * alone.area[m]);
      EXPECT_NEAR(cut.mass[n], alone.mass[m], 16.0 * kEps * alone.mass[m]);
    }
  }
}

// Fixed substeps, so that one strip can't shorten the other's. Where a solve ends within the tolerance depends on the
// other strip: a substep's positions differ by at most the tolerance of a link for each link up to the pins, and a
// difference is carried along through all 240 substeps without growing.
TEST(Slits, LetEachStripMoveAsIfItWereAlone) {
  const auto wanted = [](Scene scene) {
    scene.solver.method = Method::kImplicit;
    scene.solver.substeps = 4;
    scene.solver.stretch_tolerance = 1e-9;
    scene.wind = {draught()};
    return scene;
  };
  Scene scene = wanted(sheet(9, 12));
  scene.cloth.slits = {{4, 0}};
  Scene left = wanted(sheet(9, 5)), right = wanted(sheet(9, 7));
  right.hang.from = scene.hang.from + 5 * kLink * Vec3::UnitX();
  right.hang.to = scene.hang.to;
  Simulator both(scene), first(left), second(right);
  double apart = 0.0, blown = 0.0;
  for (int frame = 0; frame < 60; ++frame) {
    for (Simulator* each : {&both, &first, &second}) each->step();
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 12; ++j) {
        const Vec3 alone = j < 5 ? first.position({i, j}) : second.position({i, j - 5});
        apart = std::max(apart, (both.position({i, j}) - alone).norm());
        blown = std::max(blown, alone.y());
      }
    }
  }
  EXPECT_LT(apart, 240 * 8 * 1e-9 * kLink);
  EXPECT_GT(blown, 0.1);
}

// The strip that is pulled across its neighbour is stopped by it, or goes around it, but never through.
TEST(Slits, LetStripsTouchAndNotCross) {
  Scene scene = sheet(15, 12);
  scene.cloth.slits = {{2, 0}, {5, 0}, {8, 4}};
  scene.contact.self = true;
  DragParams hand;
  hand.id = "hand";
  hand.node = NodeIndex{14, 4};
  hand.target = Vec3(0.1, 0.25, 0.2);
  hand.end = 1.0;
  scene.drag = {hand};
  hand.id = "other";
  hand.node = NodeIndex{12, 7};
  hand.target = Vec3(0.0, -0.2, 0.3);
  scene.drag.push_back(hand);
  Simulator simulator(scene);
  int contacts = 0;
  for (int frame = 0; frame < 150; ++frame) {
    simulator.step();
    const Statistics& now = simulator.statistics();
    contacts = std::max(contacts, now.contacts);
    ASSERT_TRUE(now.finite) << frame;
    ASSERT_EQ(simulator.selfCrossings(), 0) << frame;
    ASSERT_LE(std::max({now.warp_stretch, now.weft_stretch, now.warp_compression}), scene.solver.stretch_tolerance)
        << frame;
  }
  EXPECT_GT(contacts, 0);
}

TEST(Slits, LeaveNoTriangleAndNoNormalAcrossThem) {
  Scene scene = sheet(5, 8);
  scene.cloth.folds = 3;
  scene.cloth.slits = {{3, 0}, {5, 3}};
  const FineMeshTopology topology = makeFineMeshTopology(scene.cloth);
  // Quads: 4 rows of 7, without a column of 4 and the lower two of another (from the row above the cut link on).
  EXPECT_EQ(topology.triangles.size(), static_cast<std::size_t>((4 * 7 - 4 - 2) * 3 * 2));
  const ClothPattern pattern = makePattern(scene);
  Field3 position, normals;
  position.assign(pattern.grid.size(), 0.0);
  normals.assign(pattern.grid.size(), 0.0);
  for (int i = 0; i < 5; ++i) {  // the right strip stands across the left one
    for (int j = 0; j < 8; ++j) position.set(pattern.grid.index(i, j), j < 4 ? Vec3(j, 0, -i) : Vec3(4, j - 4, -i));
  }
  nodeAreaVectors(pattern.grid, position, normals);
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(normals.at(pattern.grid.index(i, 3)).normalized().y(), -1.0, 4 * kEps) << i;
    EXPECT_NEAR(normals.at(pattern.grid.index(i, 4)).normalized().x(), 1.0, 4 * kEps) << i;
  }
}

}  // namespace
}  // namespace curtain
