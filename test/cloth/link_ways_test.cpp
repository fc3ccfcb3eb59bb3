// SPDX-License-Identifier: BSD-3-Clause
//
// A few nodes bound where all the others are, however the cloth is folded, and nearly as closely as their links say.
#include "cloth/link_ways.h"

#include <gtest/gtest.h>

#include <cmath>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::Random;
using curtain_test::ringScene;

// Reflects what is beyond random planes: no two points get further apart.
void foldUp(int folds, Random& random, Field3& position, std::size_t size) {
  for (int fold = 0; fold < folds; ++fold) {
    const Vec3 normal = random.direction();
    const auto node = static_cast<std::size_t>(random.between(0.0, 1.0) * static_cast<double>(size));
    const double offset = normal.dot(position.at(node));
    for (std::size_t n = 0; n < size; ++n) {
      const double beyond = normal.dot(position.at(n)) - offset;
      if (beyond > 0.0) position.add(n, -2.0 * beyond * normal);
    }
  }
}

void expectInside(const Grid& grid, const Field3& position, const Eigen::AlignedBox3d& box, const std::string& what) {
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      ASSERT_TRUE(box.contains(position.at(grid.index(i, j)))) << what << ": node " << i << ", " << j;
    }
  }
}

TEST(SampledBounds, HoldAllNodesHoweverTheClothIsFolded) {
  Random random(3);
  for (const auto& [rows, columns] : {std::pair{2, 2}, std::pair{3, 40}, std::pair{44, 40}, std::pair{100, 7}}) {
    for (const bool closed : {false, true}) {
      if (closed && columns < 3) continue;
      const Scene scene = closed ? ringScene(rows, columns, 2.0, 1.3) : flatScene(rows, columns, 2.0, 1.3);
      const ClothPattern pattern = makePattern(scene);
      const SampledBounds bounds(pattern);
      for (int folds = 0; folds < 20; ++folds) {
        Field3 position = makeInitialState(scene, pattern).position;
        foldUp(folds, random, position, pattern.grid.size());
        Field3 later = position;
        foldUp(3, random, later, pattern.grid.size());
        const std::string what = std::to_string(rows) + " x " + std::to_string(columns) + ", " + std::to_string(folds);
        expectInside(pattern.grid, position, bounds.around(position), what);
        const Vec3 way = Vec3::Constant(bounds.farthest(position, later));
        const Eigen::AlignedBox3d start = bounds.around(position);
        expectInside(pattern.grid, later, {start.min() - way, start.max() + way}, what);
      }
    }
  }
}

// The worst node: in the middle between samples that lie an eighth of the height and a quarter of the width apart.
TEST(SampledBounds, AreNoWiderThanTheWayToTheNextSample) {
  const ClothPattern pattern = makePattern(flatScene(161, 101, 2.0, 1.0));
  EXPECT_LE(SampledBounds(pattern).margin(), kOverlong * (2.0 / 16.0 + 1.0 / 8.0 + 0.0125 + 0.01));
}

// Users move pins apart as they like: a link from pin to pin holds nothing near a sample.
TEST(SampledBounds, HoldNodesAmongPins) {
  Scene scene = flatScene(12, 12);
  scene.pins.kind = PinKind::kList;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) scene.pins.nodes.push_back({i, j});
  }
  const ClothPattern pattern = makePattern(scene);
  Field3 position = makeInitialState(scene, pattern).position;
  position.set(pattern.grid.index(0, 0), {50.0, 0.0, 0.0});
  expectInside(pattern.grid, position, SampledBounds(pattern).around(position), "list");
}

TEST(SampledBounds, TellTheFurthestWay) {
  const ClothPattern pattern = makePattern(flatScene(9, 9));
  const SampledBounds bounds(pattern);
  const Field3 position = makeInitialState(flatScene(9, 9), pattern).position;
  Field3 later = position;
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) later.add(n, {0.3, 0.0, 0.4});
  EXPECT_NEAR(bounds.farthest(position, later), 0.5, 1e-12);
}

}  // namespace
}  // namespace curtain
