// SPDX-License-Identifier: BSD-3-Clause
//
// Rails in scenes: what is wrong is said once, with where and by how much; the curve is what its pieces say; carriers
// are spread between shut and open.
#include <cmath>

#include "scene/pi.h"
#include "scene/rail_layout.h"
#include "scene/rail_path.h"
#include "scene/scene_testing.h"

namespace curtain {
namespace {

std::string withRail(const std::string& rail, const std::string& more = "") {
  return "cloth: {rows: 4, columns: 9, width: 1.0" + more + "}\nrail: {" + rail + "}\n";
}

const char* const kStraight = "path: [[0, 0, 2], [1, 0, 2]]";

TEST(RailInput, IsReadWithItsArcs) {
  const Scene scene = expectScene(
      withRail("path: [[0, 0, 2], [1, 0, 2], {to: [1.5, 0.5, 2], centre: [1, 0.5, 2]}], carriers: {columns: [0, 2, 8], "
               "mass: 0.02, friction: 0.3, gap: 0.05}, opening: 0.25, drive: {speed: 0.5, force: 3}, masters: [2]"));
  ASSERT_EQ(scene.rail.path.size(), 3u);
  EXPECT_FALSE(scene.rail.path[1].centre.has_value());
  ASSERT_TRUE(scene.rail.path[2].centre.has_value());
  EXPECT_EQ(*scene.rail.path[2].centre, Vec3(1.0, 0.5, 2.0));
  EXPECT_EQ(scene.rail.carriers.columns, (std::vector<int>{0, 2, 8}));
  EXPECT_EQ(scene.rail.masters, std::vector<int>{2});
  EXPECT_EQ(scene.rail.drive.force, 3.0);
  EXPECT_EQ(scene.rail.opening, 0.25);
  EXPECT_EQ(writeScene(readSceneText(writeScene(scene)).scene), writeScene(scene));
}

TEST(RailInput, BadPathsAreNamed) {
  expectProblem(withRail("path: [[0, 0, 2]]"), "rail.path", {"at least 2 entries"});
  expectProblem(withRail("path: [[0, 0, 2], [0, 0, 2]]"), "rail.path[1]", {"must differ"});
  expectProblem(withRail("path: [[0, 0, 2], [1, 0]]"), "rail.path[1]", {"3 numbers"});
  expectProblem(withRail("path: [[0, 0, 2], {to: [1, 0, 2]}]"), "rail.path[1].centre", {"is missing"});
  expectProblem(withRail("path: [{to: [0, 0, 2], centre: [1, 0, 2]}, [1, 0, 2]]"), "rail.path[0]", {"must be a point"});
  expectProblem(withRail("path: [[0, 0, 2], {to: [1, 0, 2], centre: [0.4, 0, 2]}]"), "rail.path[1]",
                {"0.4 m", "0.6 m"});
  expectProblem(withRail("path: [[0, 0, 2], {to: [1, 0, 2], centre: [0.5, 0, 2]}]"), "rail.path[1]", {"180 degrees"});
  expectProblem(withRail("path: [[0, 0, 2], [0.1, 0, 3]]"), "rail.path[1]", {"60 degrees"});
  expectProblem(withRail("path: [[0, 0, 2], [1, 0, 2], [0.1, 0.1, 2]]"), "rail.path[2]", {"120 degrees"});
  // 120 degrees to six digits are 120 degrees.
  expectScene(withRail("path: [[0, 0, 2], [1, 0, 2], [0.499993, 0.866029, 2]]"));
  expectProblem(withRail("path: [[0, 0, 2], [1, 0, 2], [0.4995, 0.866, 2]]"), "rail.path[2]", {"120 degrees"});
  expectProblem(withRail("path: straight"), "rail.path", {"a list of points"});
}

TEST(RailInput, CarriersThatDoNotFitAreNamed) {
  const std::string straight = kStraight;
  for (const char* columns : {"[0, 4]", "[1, 8]", "[0, 4, 4, 8]", "[0, 9]"}) {
    expectProblem(withRail(straight + ", carriers: {columns: " + columns + "}"), "rail.carriers.columns",
                  {"from 0 to the last column, 8"});
  }
  expectProblem(withRail(straight + ", carriers: {columns: [0, -1, 8]}"), "rail.carriers.columns[1]", {"[0, 4095]"});
  expectProblem(withRail(straight + ", carriers: {every: 1, gap: 0.125}"), "rail.carriers.gap", {"0.125 m of cloth"});
  expectProblem(withRail("path: [[0, 0, 2], [0.1, 0, 2]], carriers: {every: 1}"), "rail.path",
                {"9 carriers take 0.12 m", "0.1 m"});
  expectProblem(withRail(straight + ", masters: [3]"), "rail.masters[0]", {"the column of a carrier", "is 3"});
  expectProblem(withRail(straight + ", masters: [0, 8]"), "rail.masters", {"neighbouring"});
}

TEST(RailInput, WhatARailDoesNotGoWithIsNamed) {
  expectProblem(withRail(kStraight) + "solver: {method: paper}\n", "solver.method", {"rail"});
  expectProblem(withRail(kStraight, ", closed: true"), "cloth.closed", {"rail"});
  expectProblem(withRail(kStraight, ", hem_width: 0.9"), "cloth.hem_width", {"rail"});
  expectProblem(withRail(kStraight, ", hem_width: 0.9998"), "cloth.hem_width", {"is 0.9998"});
  expectScene(withRail(kStraight, ", hem_width: 0.99992"));
  expectScene(withRail(kStraight, ", hem_width: 1.1"));
}

// Two metres, a quarter of a circle of 0.5 m, a metre.
TEST(RailPath, FollowsItsPieces) {
  const RailPath path(
      {{{0.0, 0.0, 2.0}, {}}, {{2.0, 0.0, 2.0}, {}}, {{2.5, 0.5, 2.0}, Vec3(2.0, 0.5, 2.0)}, {{2.5, 1.5, 2.0}, {}}});
  const double quarter = 0.25 * kPi;
  EXPECT_NEAR(path.length(), 3.0 + quarter, 1e-14);
  EXPECT_LT((path.at(0.75).point - Vec3(0.75, 0.0, 2.0)).norm(), 1e-15);
  const RailPath::Place middle = path.at(2.0 + 0.5 * quarter);
  const double root = std::sqrt(0.5);
  EXPECT_LT((middle.point - Vec3(2.0 + 0.5 * root, 0.5 - 0.5 * root, 2.0)).norm(), 1e-15);
  EXPECT_LT((middle.tangent - Vec3(root, root, 0.0)).norm(), 1e-15);
  EXPECT_LT((middle.curvature - 2.0 * Vec3(-root, root, 0.0)).norm(), 1e-14);
  EXPECT_LT((path.at(9.0).point - Vec3(2.5, 1.5, 2.0)).norm(), 1e-15);
  for (double s = 0.0; s <= path.length(); s += 0.01) {
    const RailPath::Place place = path.at(s);
    EXPECT_NEAR(path.nearest(place.point + 0.1 * Vec3::UnitZ()), s, 1e-14);
    EXPECT_NEAR(place.tangent.norm(), 1.0, 1e-15);
    // The tangent is the way's change: central differences of 1e-6, whose error is the curvature's change of 1e-6.
    if (s < 0.01 || s > path.length() - 0.01) continue;
    const Vec3 change = (path.at(s + 1e-6).point - path.at(s - 1e-6).point) / 2e-6;
    EXPECT_LT((change - place.tangent).norm(), 1e-5);
  }
}

// From what lies behind an arc, its nearer end is the nearest place.
TEST(RailPath, EndsOfAnArcAreNearestToWhatIsBehindIt) {
  const RailPath path({{{0.0, 0.0, 2.0}, {}}, {{0.5, 0.5, 2.0}, Vec3(0.0, 0.5, 2.0)}});
  EXPECT_EQ(path.nearest({-1.0, 0.2, 2.0}), 0.0);
  EXPECT_NEAR(path.nearest({0.3, 2.0, 2.0}), path.length(), 1e-15);
}

TEST(RailLayout, SpreadsCarriersFromTheirGapsToTheRail) {
  const Scene scene =
      expectScene(withRail("path: [[0, 0, 2], [0.8, 0, 2]], carriers: {columns: [0, 2, 8], gap: 0.05}"));
  const RailLayout layout(scene);
  const std::vector<double> open = layout.placesFor(1.0), shut = layout.placesFor(0.0);
  EXPECT_EQ(open, (std::vector<double>{0.0, 0.05, 0.1}));
  EXPECT_NEAR(shut[2], 0.8, 1e-15);
  // What is left beside the gaps goes by the cloth: 0.2 to 0.7.
  EXPECT_NEAR((shut[1] - 0.05) / (shut[2] - shut[1] - 0.05), 0.2 / 0.7, 1e-14);
  EXPECT_NEAR(layout.openingOf(layout.placesFor(0.3).data()), 0.3, 1e-14);
}

// A rail longer than the cloth is covered as far as the cloth reaches, nearly.
TEST(RailLayout, DrawsNoClothTaut) {
  const Scene scene = expectScene(withRail("path: [[0, 0, 2], [3, 0, 2]]"));
  const std::vector<double> shut = RailLayout(scene).placesFor(0.0);
  EXPECT_LT(shut.back(), 1.0);
  EXPECT_GT(shut.back(), 0.98);
}

TEST(RailLayout, OfAPairMeetsInTheMiddle) {
  const Scene scene = expectScene(
      withRail("path: [[0, 0, 2], [0.7, 0, 2]], carriers: {columns: [0, 2, 3, 5, 6, 8], gap: 0.02}, masters: "
               "[3, 5]"));
  const RailLayout layout(scene);
  const std::vector<double> shut = layout.placesFor(0.0), open = layout.placesFor(1.0);
  EXPECT_NEAR(shut[3] - shut[2], 0.02, 1e-15);
  EXPECT_NEAR(shut[2] + shut[3], 0.7, 1e-15);
  EXPECT_EQ(open.front(), 0.0);
  EXPECT_EQ(open.back(), 0.7);
  EXPECT_NEAR(open[3] - open[2], 0.7 - 4 * 0.02, 1e-15);
  EXPECT_EQ(layout.masters(), (std::vector<std::size_t>{2, 3}));
}

}  // namespace
}  // namespace curtain
