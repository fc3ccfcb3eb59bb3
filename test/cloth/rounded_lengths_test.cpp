// SPDX-License-Identifier: BSD-3-Clause
//
// Lengths in a scene that must fit each other are computed and rounded by others: what is out by less than a
// ten-thousandth is taken for what fits, and no link, line or loop starts longer than it is.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "cloth/cords.h"
#include "curtain_sim/scene_yaml.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::kPi;

std::string digits(double value) {
  std::ostringstream text;
  text.precision(17);
  text << std::fixed << value;
  return text.str();
}

std::vector<std::string> keysOf(const std::vector<Problem>& problems) {
  std::vector<std::string> keys;
  for (const Problem& problem : problems) keys.push_back(problem.key);
  return keys;
}

using Keys = std::vector<std::string>;

// Problems of a scene, with those that show when the cloth is in its place.
Keys problemKeys(const std::string& yaml) {
  const SceneReading reading = readSceneText(yaml);
  if (!reading.problems.empty()) return keysOf(reading.problems);
  return keysOf(problemsAtStart(reading.scene, makePattern(reading.scene)));
}

// The largest length of a link over its own, less 1.
double overlength(const Scene& scene) {
  const ClothPattern pattern = makePattern(scene);
  const ClothState state = makeInitialState(scene, pattern);
  double most = -1.0;
  forEachLink(pattern, [&](std::size_t a, std::size_t b, double rest, bool) {
    most = std::max(most, (state.position.at(a) - state.position.at(b)).norm() / rest - 1.0);
  });
  return most;
}

// Positions of metres are rounded to 1e-16 m, links here are centimetres long.
constexpr double kSumRounding = 1e-12;

void expectNothingOverlong(const std::string& yaml) {
  SCOPED_TRACE(yaml);
  const SceneReading reading = readSceneText(yaml);
  ASSERT_TRUE(reading.problems.empty()) << describe(reading.problems);
  EXPECT_LE(overlength(reading.scene), kSumRounding);
}

TEST(RoundedLengths, TheLineIsAsLongAsTheClothIsWide) {
  const std::string cloth = "cloth: {rows: 4, columns: 5, height: 0.05, width: 0.035903}\n";
  expectNothingOverlong(cloth + "hang: {from: [0, 0, 0], to: [0.035904, 0, 0]}");
  expectNothingOverlong(cloth + "hang: {from: [0, 0, 0], to: [0.035904, 0, 0], tilt: 1.0}");
  EXPECT_EQ(problemKeys(cloth + "hang: {from: [0, 0, 0], to: [0.03591, 0, 0]}"), Keys{"hang.to"});
  const SceneReading reading = readSceneText(cloth + "hang: {from: [0, 0, 0], to: [0.035904, 0, 0]}");
  const ClothPattern pattern = makePattern(reading.scene);
  const ClothState state = makeInitialState(reading.scene, pattern);
  const double width =
      (state.position.at(pattern.grid.index(0, 4)) - state.position.at(pattern.grid.index(0, 0))).norm();
  EXPECT_NEAR(width, 0.035903, 1e-15) << "flat";
}

TEST(RoundedLengths, TheLineIsAsLongAsOverlappingStripsReach) {
  const std::string strips = "cloth: {rows: 4, columns: 8, height: 0.5, width: 0.7, slits: [1, 3, 5]}\n";
  expectNothingOverlong(strips + "hang: {overlap: 0.04, from: [0, 0, 0], to: [0.28002, 0, 0]}");
  EXPECT_EQ(problemKeys(strips + "hang: {overlap: 0.04, from: [0, 0, 0], to: [0.2801, 0, 0]}"), Keys{"hang.to"});
}

TEST(RoundedLengths, ATaperedClothHangsFromItsLine) {
  const std::string cloth = "cloth: {rows: 6, columns: 5, height: 1.0, width: 1.0, hem_width: ";
  for (const char* hem : {"0.99995", "1.0", "1.00005", "1.4"})
    expectNothingOverlong(cloth + hem + "}\nhang: {from: [0, 0, 0], to: [1.00009, 0, 0]}");
}

TEST(RoundedLengths, FullnessIsWidthOverSpan) {
  const std::string hang = "hang: {from: [0, 0, 0], to: [0.7, 0, 0], fullness: ";
  expectNothingOverlong("cloth: {rows: 4, columns: 41, width: 1.1667}\n" + hang + "1.6666667, heading: ripple}");
  EXPECT_EQ(problemKeys("cloth: {rows: 4, columns: 41, width: 1.1669}\n" + hang + "1.6666667}"), Keys{"hang.fullness"});
}

TEST(RoundedLengths, PleatsKeepTheirLinks) {
  const auto pleated = [](const char* hem, const char* to) {
    return std::string("cloth: {rows: 4, columns: 41, width: 1.0, hem_width: ") + hem +
           "}\nhang: {heading: ripple, from: [0, 0, 0], to: [" + to + ", 0, 0]}";
  };
  for (const char* hem : {"0.99991", "1.0", "1.00009"})
    for (const char* to : {"0.33333", "0.5", "0.99995", "1.00009"}) expectNothingOverlong(pleated(hem, to));
  EXPECT_EQ(problemKeys(pleated("0.9998", "0.5")), Keys{"hang.heading"});
  EXPECT_EQ(problemKeys(pleated("1.0002", "0.5")), Keys{"hang.heading"});
  EXPECT_EQ(problemKeys(pleated("1.0", "0.3332")), Keys{"hang.heading"});
}

// The hung ring is a polygon of the weft links; its radius is theirs over twice the sine of half their angle.
TEST(RoundedLengths, RingsAreAsWideAsTheirWeft) {
  const double radius = 1.0 / 8.0 / (2.0 * std::sin(kPi / 8.0));
  const auto ring = [](double wide, double hem, double tilt) {
    return "cloth: {rows: 9, columns: 8, closed: true, height: 1.0, width: 1.0, hem_width: " + digits(hem) +
           "}\nhang: {from: [0, 0, 0], radius: " + digits(wide) + ", tilt: " + digits(tilt) + "}";
  };
  expectNothingOverlong(ring(1.00009 * radius, 1.0, 0.0));
  EXPECT_EQ(problemKeys(ring(1.0002 * radius, 1.0, 0.0)), Keys{"hang.radius"});
  // A cone as wide as its weft everywhere: its radii differ by height times the sine of the tilt.
  for (const double hem : {0.5, 2.0, 4.0}) {
    const double tilt = std::asin((hem - 1.0) * radius);
    expectNothingOverlong(ring(1.00004 * radius, hem, tilt));
    expectNothingOverlong(ring(radius, hem, tilt + 5e-6));
  }
  // Down to a tip: the rings are drawn in, and none of them through its centre.
  const double hem = 2e-5;
  for (const std::string& key : problemKeys(ring(1.00009 * radius, hem, std::asin((hem - 1.0) * radius))))
    EXPECT_EQ(key, "hang.tilt");
}

TEST(RoundedLengths, ALineReachesItsEnd) {
  const auto line = [](const char* length, const char* more = "") {
    return std::string(
               "cloth: {rows: 4, columns: 3, height: 0.9, width: 1.0}\nhang: {from: [0, 0, 2], to: [1, 0, 2]}\n") +
           "lines: [{id: a, nodes: [[0, 0], [0, 2]], to: [0.5, 1.2, 2], length: " + length + more + "}]";
  };
  for (const char* more : {"", ", mass: 0.1"}) {
    EXPECT_EQ(problemKeys(line("1.2999", more)), Keys{});
    EXPECT_EQ(problemKeys(line("1.2997", more)), Keys{"lines[0].length"});
    const Scene scene = readSceneText(line("1.2999", more)).scene;
    for (const Cord& cord : makePattern(scene).cords.cords) EXPECT_NEAR(cord.length, 1.3, 1e-15);
  }
  for (const Cord& cord : makePattern(readSceneText(line("1.4")).scene).cords.cords) EXPECT_EQ(cord.length, 1.4);
}

// The pinned node is 0.6 m of rods away from the loop's row.
TEST(RoundedLengths, ALoopIsWithinTheClothsReach) {
  const auto tie = [](const char* y) {
    return std::string(
               "cloth: {rows: 4, columns: 3, height: 0.9, width: 1.0}\nhang: {from: [0, 0, 2], to: [1, 0, 2]}\n") +
           "tie_back: [{id: a, row: 2, first_column: 0, last_column: 0, radius: 0.1, point: [0, " + y + ", 2]}]";
  };
  EXPECT_EQ(problemKeys(tie("0.70006")), Keys{});
  EXPECT_EQ(problemKeys(tie("0.7002")), Keys{"tie_back[0].point"});
  const CordsPattern cords = makePattern(readSceneText(tie("0.70006")).scene).cords;
  EXPECT_NEAR(cords.loops.at(0).radius, 0.10006, 1e-12);
  EXPECT_NEAR(cords.cords.at(0).length, 0.10006, 1e-12);
  EXPECT_EQ(makePattern(readSceneText(tie("0.69")).scene).cords.loops.at(0).radius, 0.1);
}

TEST(RoundedLengths, ClothOnARailIsNoWiderThanItsHem) {
  for (const char* hem : {"0.99992", "1.0", "1.00005"})
    expectNothingOverlong(std::string("cloth: {rows: 4, columns: 9, width: 1.0, hem_width: ") + hem +
                          "}\nrail: {path: [[0, 0, 2], [2, 0, 2]], carriers: {every: 4}}");
}

}  // namespace
}  // namespace curtain
