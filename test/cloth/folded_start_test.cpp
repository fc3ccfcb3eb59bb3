// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth whose wefts push starts in folds: its rods and wefts at their lengths, hung where it is hung, and no fold in
// another's room.
#include "cloth/folded_start.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scene/ring_start.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;
using curtain_test::kPi;
using curtain_test::Random;
using curtain_test::ringScene;

// Positions are rounded to eps of their size (below 8 m here) at both ends of a link, after at most `rows` additions.
constexpr double kFoldRounding = 64.0 * 8.0 * kEps;  // [m] 1.1e-13

Scene pushing(Scene scene) {
  scene.cloth.surface_density = 0.2;
  scene.cloth.bending_warp = scene.cloth.bending_weft = 1e-5;
  scene.cloth.shear = 10.0;
  return scene;
}

Scene gathered(int rows, int columns, double width, double share, int every) {
  Scene scene = pushing(flatScene(rows, columns, 1.8, width));
  scene.hang.to = scene.hang.from + share * Vec3(0.6 * width, 0.8 * width, 0.0);
  scene.pins.kind = PinKind::kList;
  for (int j = 0; j < columns; j += every) scene.pins.nodes.push_back({0, j});
  return scene;
}

// The same cloth, as it is placed without folds.
Scene limp(Scene scene) {
  scene.cloth.shear = 0.0;
  return scene;
}

struct FoldedStart {
  explicit FoldedStart(const Scene& scene)
      : pattern(makePattern(scene)), position(makeInitialState(scene, pattern).position) {}
  Vec3 at(int i, int j) const { return position.at(pattern.grid.index(i, j)); }
  // Lengths of rods, or wefts, over those at rest: the smallest and the largest.
  std::pair<double, double> lengths(bool of_rods) const {
    double least = 1e9, most = 0.0;
    forEachLink(pattern, [&](std::size_t a, std::size_t b, double rest, bool rod) {
      if (rod != of_rods) return;
      const double length = (position.at(a) - position.at(b)).norm() / rest;
      least = std::min(least, length);
      most = std::max(most, length);
    });
    return {least, most};
  }
  ClothPattern pattern;
  Field3 position;
};

TEST(FoldedStart, LinksHaveTheirLengthsAndPinsTheirPlaces) {
  for (const int every : {2, 3, 4, 8}) {
    for (const double share : {0.5, 0.6, 0.8, 0.99}) {
      const Scene scene = gathered(20, 25, 1.5, share, every);
      const FoldedStart start(scene), plain(limp(scene));
      SCOPED_TRACE(std::to_string(every) + ". column, gathered to " + std::to_string(share));
      EXPECT_NEAR(start.lengths(true).first, 1.0, 1e-12);
      EXPECT_NEAR(start.lengths(true).second, 1.0, 1e-12);
      // A bisection of angles ends at 1e-11 of them.
      EXPECT_NEAR(start.lengths(false).first, 1.0, 1e-9);
      EXPECT_LE(start.lengths(false).second, 1.0 + 1e-11);
      for (int j = 0; j < 25; j += every) EXPECT_LE((start.at(0, j) - plain.at(0, j)).norm(), kFoldRounding);
    }
  }
}

TEST(FoldedStart, FrontsAndBacksAlternate) {
  const FoldedStart start(gathered(6, 13, 1.2, 0.6, 3));
  const Vec3 front(0.8, -0.6, 0.0);
  const auto out = [&](int row, int j) { return (start.at(row, j) - start.at(0, 0)).dot(front); };
  for (int row = 0; row < 6; ++row) {
    for (int j = 1; j < 12; ++j) {
      if (j % 3 == 0) {
        EXPECT_NEAR(out(row, j), 0.0, kFoldRounding);
      } else {
        EXPECT_GT(std::abs(out(row, j)), 0.05);
        if (j > 3) {
          EXPECT_LT(out(row, j) * out(row, j - 3), 0.0) << row << ", " << j;
        }
      }
    }
  }
}

// Where every node of the top row is pinned it is straight; folds grow down from there.
TEST(FoldedStart, FoldsGrowDownFromAStraightTop) {
  const Scene scene = gathered(40, 40, 1.0, 0.6, 1);
  const FoldedStart start(scene), plain(limp(scene));
  const Vec3 front(0.8, -0.6, 0.0);
  double before = -1.0;
  for (int i = 0; i < 40; ++i) {
    double deepest = 0.0;
    for (int j = 0; j < 40; ++j) {
      EXPECT_LE((start.at(0, j) - plain.at(0, j)).norm(), kFoldRounding);
      deepest = std::max(deepest, std::abs((start.at(i, j) - plain.at(i, j)).dot(front)));
    }
    EXPECT_GE(deepest, before - 1e-6) << "row " << i;
    before = deepest;
  }
  EXPECT_GT(before, 0.03);
  EXPECT_NEAR(start.lengths(true).second, 1.0, 1e-12);
  double hem = 0.0;
  for (int j = 1; j < 40; ++j) hem += (start.at(39, j) - start.at(39, j - 1)).norm();
  EXPECT_GT(hem, 0.99);
}

// Flat it would be in balance, though not a stable one. Its own wave is shorter than a link.
TEST(FoldedStart, LimpClothIsNotFlatEither) {
  Scene scene = gathered(40, 40, 1.0, 0.6, 1);
  scene.cloth.bending_weft = 1e-9;
  const FoldedStart start(scene), plain(limp(scene));
  const Vec3 front(0.8, -0.6, 0.0);
  for (int j = 1; j < 39; j += 2) EXPECT_GT(std::abs((start.at(39, j) - plain.at(39, j)).dot(front)), 1e-3);
  EXPECT_NEAR(start.lengths(true).second, 1.0, 1e-12);
}

TEST(FoldedStart, ClothThatDoesNotPushLiesFlat) {
  Scene scene = gathered(9, 13, 1.0, 0.6, 3);
  const FoldedStart plain(limp(scene));
  scene.cloth.bending_weft = 0.0;
  const FoldedStart unbending(scene);
  EXPECT_EQ(plain.position.x, unbending.position.x);
  EXPECT_EQ(plain.position.y, unbending.position.y);
  EXPECT_EQ(plain.position.z, unbending.position.z);
}

TEST(FoldedStart, ClothAsWideAsItsEdgeIsFlat) {
  const Scene scene = pushing(flatScene(9, 16));
  const FoldedStart start(scene), plain(limp(scene));
  for (std::size_t n = 0; n < start.pattern.grid.size(); ++n)
    ASSERT_LE((start.position.at(n) - plain.position.at(n)).norm(), kFoldRounding);
}

TEST(FoldedStart, RingsFoldToTheirOutside) {
  Scene scene = pushing(ringScene(12, 48, 1.0, 2.0));
  scene.hang.radius = 0.2;
  scene.pins.kind = PinKind::kList;
  for (int j = 0; j < 48; j += 6) scene.pins.nodes.push_back({0, j});
  const FoldedStart start(scene);
  EXPECT_NEAR(start.lengths(true).second, 1.0, 1e-12);
  EXPECT_GT(start.lengths(false).first, 0.9);  // 0.63 without folds
  EXPECT_LE(start.lengths(false).second, 1.0 + 1e-11);
  const double least = hungRadius(scene) * std::cos(kPi / 8.0);  // of the chord from pin to pin
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 48; ++j) {
      const Vec3 out = start.at(i, j) - scene.hang.from;
      EXPECT_GE(std::sqrt(out.x() * out.x() + out.y() * out.y()), least - kFoldRounding);
    }
  }
}

// On a rail, too, where cloth without shear hangs through.
TEST(FoldedStart, ClothOnARailFoldsBetweenItsCarriers) {
  Scene scene = pushing(flatScene(20, 33, 1.5, 3.0));
  scene.hang = HangParams();
  scene.rail.path = {{Vec3(0.0, 0.0, 2.0), std::nullopt}, {Vec3(2.0, 0.0, 2.0), std::nullopt}};
  scene.rail.carriers.every = 4;
  ASSERT_TRUE(validate(scene).empty()) << describe(validate(scene));
  for (const double opening : {0.0, 0.3}) {
    scene.rail.opening = opening;
    const FoldedStart start(scene);
    EXPECT_NEAR(start.lengths(true).second, 1.0, 1e-12);
    EXPECT_GT(start.lengths(false).first, 0.99) << opening;
    EXPECT_LE(start.lengths(false).second, 1.0 + 1e-11);
  }
}

// Between pins shear bears whole columns: the cells on either side pull up what they weigh, to rounding.
TEST(FoldedStart, ColumnsHangByShearAsTheyWeigh) {
  const Scene scene = gathered(15, 25, 1.5, 0.6, 4);
  const FoldedStart start(scene);
  const double rest = 1.5 / 24.0, height = scene.cloth.height;
  for (int j = 1; j < 24; ++j) {
    if (j % 4 == 0) continue;
    const double z = start.at(0, j).z();
    const double slopes = (start.at(0, j - 1).z() - z + start.at(0, j + 1).z() - z) / rest;
    double mass = 0.0;
    for (int i = 0; i < 15; ++i) mass += start.pattern.mass[start.pattern.grid.index(i, j)];
    EXPECT_NEAR(scene.cloth.shear * height * slopes, mass * 9.81, 1e-9) << "column " << j;
  }
}

Scene randomScene(Random& random) {
  const int rows = static_cast<int>(random.between(4.0, 24.0)), columns = static_cast<int>(random.between(6.0, 30.0));
  const bool closed = random.between(0.0, 1.0) < 0.25;
  const double width = random.between(0.5, 2.5), share = random.between(0.2, 1.0);
  Scene scene = pushing(closed ? ringScene(rows, columns, random.between(0.5, 2.0), width)
                               : flatScene(rows, columns, random.between(0.5, 2.0), width));
  scene.cloth.shear = std::pow(10.0, random.between(-1.0, 2.0));
  scene.cloth.bending_weft = std::pow(10.0, random.between(-6.0, -3.0));
  if (random.between(0.0, 1.0) < 0.4) scene.cloth.hem_width = width * random.between(0.8, 1.2);
  if (random.between(0.0, 1.0) < 0.4) {
    for (int j = 0; j < columns - (closed ? 0 : 1); ++j) scene.cloth.column_spacing.push_back(random.between(0.6, 1.6));
    for (int i = 0; i + 1 < rows; ++i) scene.cloth.row_spacing.push_back(random.between(0.6, 1.6));
  }
  if (closed) {
    scene.hang.radius = share * width / (2.0 * kPi);
  } else {
    scene.hang.to = scene.hang.from + share * width * Vec3(0.8, 0.6, 0.0);
    scene.hang.tilt = random.between(-1.0, 1.0);
    if (random.between(0.0, 1.0) < 0.3) scene.cloth.slits = {{columns / 2, rows / 2}};
  }
  const int every = static_cast<int>(random.between(1.0, 9.0));
  scene.pins.kind = PinKind::kList;
  for (int j = 0; j < columns; j += every) scene.pins.nodes.push_back({0, j});
  return scene;
}

TEST(FoldedStart, KeepsRodsAndOverstretchesNothingInRandomScenes) {
  Random random(2026);
  int folded = 0, tried = 0;
  while (tried < 300) {
    const Scene scene = randomScene(random);
    if (!validate(scene).empty()) continue;
    SCOPED_TRACE("scene " + std::to_string(tried++));
    const FoldedStart start(scene), plain(limp(scene));
    ASSERT_NEAR(start.lengths(true).first, 1.0, 1e-11);
    ASSERT_NEAR(start.lengths(true).second, 1.0, 1e-11);
    ASSERT_LE(start.lengths(false).second, 1.0 + 1e-11);
    for (const NodeIndex& pin : scene.pins.nodes)
      ASSERT_LE((start.at(pin.row, pin.column) - plain.at(pin.row, pin.column)).norm(), kFoldRounding);
    double longer = 0.0;
    forEachLink(start.pattern, [&](std::size_t a, std::size_t b, double, bool rod) {
      if (!rod)
        longer +=
            (start.position.at(a) - start.position.at(b)).norm() - (plain.position.at(a) - plain.position.at(b)).norm();
    });
    folded += longer > 1e-6 ? 1 : 0;
  }
  EXPECT_GT(folded, 250);
}

}  // namespace
}  // namespace curtain
