// SPDX-License-Identifier: BSD-3-Clause
//
// Where a cloth starts: at rest, its rods exactly as long as they are, on the line or ring that scene.hang gives,
// turned out of the vertical by its tilt.
#include <gtest/gtest.h>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;
using curtain_test::kPi;
using curtain_test::Random;
using curtain_test::ringScene;

struct Start {
  explicit Start(const Scene& scene) : pattern(makePattern(scene)), state(makeInitialState(scene, pattern)) {}
  Vec3 at(int i, int j) const { return state.position.at(pattern.grid.index(i, j)); }
  ClothPattern pattern;
  ClothState state;
};

// Positions are rounded to eps of their size (below 8 m here) at both ends of a link, after at most `rows` additions.
constexpr double kRounding = 64.0 * 8.0 * kEps;  // [m] 1.1e-13

void expectRodsKeepTheirLength(const Start& start) {
  const Grid& grid = start.pattern.grid;
  for (int i = 1; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      ASSERT_NEAR((start.at(i, j) - start.at(i - 1, j)).norm(), start.pattern.warp_rest[grid.index(i, j)], kRounding)
          << "rod to " << i << ", " << j;
    }
  }
}

TEST(InitialState, IsAtRest) {
  const Start start(flatScene(4, 5));
  EXPECT_EQ(start.state.velocity_age, 0.0);
  for (const Field* axis : {&start.state.velocity.x, &start.state.velocity.y, &start.state.velocity.z}) {
    ASSERT_EQ(axis->size(), start.pattern.grid.size());
    for (const double v : *axis) EXPECT_EQ(v, 0.0);
  }
}

TEST(InitialState, FlatSheetHasEveryLinkAtItsRestLength) {
  Scene scene = flatScene(6, 9, 1.5, 2.0);
  scene.hang.from = {1.0, -2.0, 3.0};
  scene.hang.to = scene.hang.from + 2.0 * Vec3(0.6, 0.8, 0.0);
  scene.hang.tilt = 0.4;
  scene.cloth.row_spacing = {1.0, 2.0, 1.0, 3.0, 0.5};
  scene.cloth.column_spacing = {1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 3.0, 4.0};
  const Start start(scene);
  expectRodsKeepTheirLength(start);
  for (int i = 0; i < 6; ++i) {
    for (int j = 1; j < 9; ++j) {
      EXPECT_NEAR((start.at(i, j) - start.at(i, j - 1)).norm(), start.pattern.weft_rest[start.pattern.grid.index(i, j)],
                  kRounding);
    }
  }
  EXPECT_LE((start.at(0, 0) - scene.hang.from).norm(), kRounding);
  EXPECT_LE((start.at(0, 8) - scene.hang.to).norm(), kRounding);
}

TEST(InitialState, GatheredSheetLiesEvenlyOnTheLine) {
  Scene scene = flatScene(5, 11, 1.0, 2.0);
  scene.hang.to = scene.hang.from + Vec3(1.2, 0.0, 0.0);
  const Start start(scene);
  expectRodsKeepTheirLength(start);
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 11; ++j) {
      EXPECT_LE((start.at(i, j) - Vec3(0.12 * j, 0.0, 1.0 - 0.25 * i)).norm(), kRounding) << i << ", " << j;
    }
  }
}

TEST(InitialState, TiltTurnsTheClothTowardsTheLineCrossUp) {
  Random random(11);
  for (int trial = 0; trial < 50; ++trial) {
    Scene scene = flatScene(3, 4, 1.0, 1.0);
    const double heading = random.between(0.0, 2.0 * kPi);
    const Vec3 along(std::cos(heading), std::sin(heading), 0.0);
    scene.hang.to = scene.hang.from + along;
    scene.hang.tilt = random.between(-kPi, kPi);
    const Start start(scene);
    const Vec3 down = start.at(2, 1) - start.at(0, 1);
    const Vec3 towards = along.cross(Vec3::UnitZ());
    const Vec3 expected = std::cos(scene.hang.tilt) * -Vec3::UnitZ() + std::sin(scene.hang.tilt) * towards;
    EXPECT_LE((down - expected).norm(), kRounding) << "tilt " << scene.hang.tilt;
  }
  Scene scene = flatScene(3, 4);
  scene.hang.tilt = 0.5 * kPi;
  const Start start(scene);
  EXPECT_LE((start.at(2, 0) - (scene.hang.from + Vec3(0.0, -1.0, 0.0))).norm(), kRounding) << "x cross z is -y";
}

TEST(InitialState, SlopingAndUprightHungEdgesStillHangAsRodsOfTheirLength) {
  for (const Vec3& along : {Vec3(0.6, 0.0, 0.8), Vec3(0.0, 0.0, 1.0), Vec3(0.0, 0.0, -1.0)}) {
    Scene scene = flatScene(4, 5);
    scene.hang.to = scene.hang.from + along;
    const Start start(scene);
    expectRodsKeepTheirLength(start);
    const Vec3 down = start.at(3, 2) - start.at(0, 2);
    EXPECT_NEAR(down.dot(along), 0.0, kRounding) << "warp and weft are square to each other";
  }
  Scene scene = flatScene(4, 5);
  scene.hang.to = scene.hang.from + Vec3(0.6, 0.0, 0.8);
  EXPECT_LT(Start(scene).at(3, 2).z(), Start(scene).at(0, 2).z()) << "and down is down";
}

// Of all wefts, over their own lengths.
double longestWeft(const Start& start) {
  double longest = 0.0;
  forEachLink(start.pattern, [&](std::size_t a, std::size_t b, double rest, bool rod) {
    if (!rod) longest = std::max(longest, (start.state.position.at(a) - start.state.position.at(b)).norm() / rest);
  });
  return longest;
}

TEST(InitialState, NarrowingSheetStartsAsAFanWhoseHemIsTaut) {
  Scene scene = flatScene(21, 9, 2.0, 1.0);
  scene.cloth.hem_width = 0.4;
  const Start start(scene);
  expectRodsKeepTheirLength(start);
  EXPECT_NEAR(longestWeft(start), 1.0, 1e-12) << "no narrower than it must be";
  const double hem = start.at(20, 8).x() - start.at(20, 0).x();
  EXPECT_LT(hem, 0.4);
  for (int i = 0; i < 21; ++i) {
    EXPECT_NEAR(start.at(i, 8).x() - start.at(i, 0).x(), 1.0 + (hem - 1.0) * i / 20.0, kRounding);
    EXPECT_NEAR(0.5 * (start.at(i, 8).x() + start.at(i, 0).x()), 0.5, kRounding) << "symmetric";
  }
}

TEST(InitialState, SheetWithAWiderHemHangsPlumb) {
  Scene scene = flatScene(21, 9, 2.0, 1.0);
  scene.cloth.hem_width = 1.7;
  const Start start(scene);
  expectRodsKeepTheirLength(start);
  for (int j = 0; j < 9; ++j) EXPECT_LE((start.at(20, j) - start.at(0, j) - Vec3(0.0, 0.0, -2.0)).norm(), kRounding);
}

// Whether a hem of this width in plan leaves every weft of every row its length.
bool fits(const Scene& scene, const ClothPattern& pattern, double hem) {
  const double span = (scene.hang.to - scene.hang.from).norm(), height = scene.cloth.height;
  for (int j = 1; j < pattern.grid.columns; ++j) {
    const auto lean = [&](int column) {
      const double share = pattern.weft_coordinate[static_cast<std::size_t>(column)] / scene.cloth.width - 0.5;
      return share * (span - hem) / height;
    };
    const double left = lean(j - 1), right = lean(j);
    if (std::abs(left) > 1.0 || std::abs(right) > 1.0) return false;
    const double share = (pattern.weft_coordinate[static_cast<std::size_t>(j)] -
                          pattern.weft_coordinate[static_cast<std::size_t>(j - 1)]) /
                         scene.cloth.width;
    for (int i = 0; i < pattern.grid.rows; ++i) {
      const double depth = pattern.warp_coordinate[pattern.grid.index(i, j)];
      const double across = share * (span + (hem - span) * depth / height);
      const double rise = depth * (std::sqrt(1.0 - left * left) - std::sqrt(1.0 - right * right));
      if (std::hypot(across, rise) > (1.0 - 1e-9) * pattern.weft_rest[pattern.grid.index(i, j)]) return false;
    }
  }
  return true;
}

// Steep and mild tapers, with rows and columns of any width, gathered or taut: no weft starts too long, and what is
// refused has no fan of any width.
TEST(InitialState, NoWeftOfATaperedSheetStartsTooLong) {
  Random random(20261128);
  int started = 0, refused = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const int rows = static_cast<int>(random.between(2.0, 14.0)), columns = static_cast<int>(random.between(2.0, 20.0));
    const double width = random.between(0.3, 3.0);
    Scene scene = flatScene(rows, columns, random.between(0.2, 3.0), width);
    scene.cloth.hem_width = width * std::pow(10.0, random.between(-2.0, 0.2));
    scene.hang.to = scene.hang.from + random.between(0.3, 1.0) * width * Vec3(0.8, 0.6, 0.0);
    if (random.between(0.0, 1.0) < 0.5) {
      for (int j = 0; j + 1 < columns; ++j) scene.cloth.column_spacing.push_back(random.between(0.2, 3.0));
      for (int i = 0; i + 1 < rows; ++i) scene.cloth.row_spacing.push_back(random.between(0.2, 3.0));
    }
    SCOPED_TRACE("trial " + std::to_string(trial));
    if (validate(scene).empty()) {
      ++started;
      const Start start(scene);
      expectRodsKeepTheirLength(start);
      ASSERT_LE(longestWeft(start), 1.0 + 1e-11);
      continue;
    }
    ++refused;
    const ClothPattern pattern = makePattern(scene);
    const double most = std::min((scene.hang.to - scene.hang.from).norm(), *scene.cloth.hem_width);
    for (int k = 0; k <= 1000; ++k)
      ASSERT_FALSE(fits(scene, pattern, 1e-3 * k * most)) << "a hem of " << k << " / 1000";
  }
  EXPECT_GT(started, 200);
  EXPECT_GT(refused, 60);
}

// Its strips lean as one, and overlap as they do at the top, by their share of the width.
TEST(InitialState, OverlappingStripsOfANarrowingSheetKeepTheirWefts) {
  Scene scene = flatScene(9, 9, 2.0, 0.7);
  scene.cloth.hem_width = 0.5;
  scene.cloth.slits = {{2, 0}, {5, 0}};
  scene.contact.thickness = 0.003;
  scene.hang.overlap = 0.04;
  scene.hang.to = scene.hang.from + Vec3(0.0, 0.3, 0.0);
  ASSERT_TRUE(validate(scene).empty()) << describe(validate(scene));
  const Start start(scene);
  expectRodsKeepTheirLength(start);
  EXPECT_LE(longestWeft(start), 1.0 + 1e-12);
}

// Three strips of 0.2 m: 0.6 m less two overlaps. The middle one hangs behind the others.
TEST(InitialState, OverlappingStripsHangBoardOnBoard) {
  Scene scene = flatScene(4, 9, 1.0, 0.7);
  scene.cloth.column_spacing = {2.0, 2.0, 1.0, 2.0, 2.0, 1.0, 2.0, 2.0};
  scene.cloth.slits = {{2, 0}, {5, 0}};
  scene.contact.thickness = 0.003;
  scene.hang.overlap = 0.04;
  scene.hang.to = scene.hang.from + Vec3(0.0, 0.52, 0.0);
  ASSERT_TRUE(validate(scene).empty()) << describe(validate(scene));
  const Start start(scene);
  expectRodsKeepTheirLength(start);
  for (int j = 0; j < 9; ++j) {
    const int strip = j / 3;
    const double along = 0.16 * strip + 0.1 * (j % 3), in_front = strip == 1 ? -0.003 : 0.003;
    for (int i = 0; i < 4; ++i) {
      // Along +y the front, along x down, is the side of -x.
      EXPECT_LT((start.at(i, j) - Vec3(-in_front, along, 1.0 - i / 3.0)).norm(), kRounding)
          << "node " << i << ", " << j;
    }
    EXPECT_EQ(start.pattern.pinned[start.pattern.grid.index(0, j)], kPinned);
  }
}

// A shorter line gathers strips and overlaps alike, as it does whole cloth.
TEST(InitialState, OverlappingStripsGather) {
  Scene scene = flatScene(3, 6, 1.0, 0.5);
  scene.cloth.slits = {{2, 0}};
  scene.hang.overlap = 0.05;
  scene.hang.to = scene.hang.from + Vec3(0.175, 0.0, 0.0);
  ASSERT_TRUE(validate(scene).empty()) << describe(validate(scene));
  const Start start(scene);
  EXPECT_NEAR(start.at(2, 2).x(), 0.1, kRounding) << "half of the strip's 0.2 m";
  EXPECT_NEAR(start.at(2, 3).x(), 0.075, kRounding) << "half of the overlap before it";
  EXPECT_NEAR(start.at(2, 5).x(), 0.175, kRounding);
}

TEST(InitialState, RingHangsAroundItsCentre) {
  Scene scene = ringScene(4, 12, 0.9, 1.5);
  const Start start(scene);
  expectRodsKeepTheirLength(start);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 12; ++j) {
      const Vec3 from_centre = start.at(i, j) - scene.hang.from;
      EXPECT_NEAR(std::hypot(from_centre.x(), from_centre.y()), 1.5 / (2.0 * kPi), kRounding) << "default radius";
      EXPECT_NEAR(from_centre.z(), -0.3 * i, kRounding);
    }
  }
  EXPECT_NEAR(start.at(0, 3).x(), 0.0, kRounding) << "columns run counter-clockwise as seen from above";
  EXPECT_GT(start.at(0, 3).y(), 0.0);
}

TEST(InitialState, RingOfGivenRadiusOpensAsACone) {
  Scene scene = ringScene(6, 16, 1.0, 0.8);
  scene.cloth.hem_width = 3.0;
  scene.hang.radius = 0.1;
  scene.hang.tilt = 0.3;
  const Start start(scene);
  expectRodsKeepTheirLength(start);
  for (int i = 0; i < 6; ++i) {
    const double along = 0.2 * i;
    for (int j = 0; j < 16; ++j) {
      const Vec3 from_centre = start.at(i, j) - scene.hang.from;
      EXPECT_NEAR(std::hypot(from_centre.x(), from_centre.y()), 0.1 + along * std::sin(0.3), kRounding);
      EXPECT_NEAR(from_centre.z(), -along * std::cos(0.3), kRounding);
      const Vec3 left = start.at(i, (j + 15) % 16);
      EXPECT_LE((start.at(i, j) - left).norm(), start.pattern.weft_rest[start.pattern.grid.index(i, j)] + kRounding);
    }
  }
}

TEST(InitialState, UnevenRingPutsItsColumnsAtTheirShareOfTheTurn) {
  Scene scene = ringScene(2, 4, 1.0, 1.0);
  scene.cloth.column_spacing = {1.0, 2.0, 3.0, 4.0};
  const Start start(scene);
  const double shares[] = {0.0, 0.1, 0.3, 0.6};
  for (int j = 0; j < 4; ++j) {
    const Vec3 from_centre = start.at(0, j) - scene.hang.from;
    const double radius = 1.0 / (2.0 * kPi);
    const Vec3 expected(radius * std::cos(2.0 * kPi * shares[j]), radius * std::sin(2.0 * kPi * shares[j]), 0.0);
    EXPECT_LE((from_centre - expected).norm(), kRounding);
  }
}

}  // namespace
}  // namespace curtain
