// SPDX-License-Identifier: BSD-3-Clause
//
// A node's area vector is the sum of the area vectors of the corner triangles of the faces at it. On flat cloth the
// corner triangles cover twice the node's share of the cloth, so it is 2 x area x normal everywhere, borders included.
#include <gtest/gtest.h>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;
using curtain_test::kPi;
using curtain_test::Random;
using curtain_test::randomPositions;
using curtain_test::ringScene;

// Quadrant by quadrant, with the orientation (down the warp) x (along the weft).
Vec3 bruteForce(const Grid& grid, const Field3& position, int i, int j) {
  const Vec3 here = position.at(grid.index(i, j));
  Vec3 sum = Vec3::Zero();
  for (const int di : {-1, 1}) {
    for (const int dj : {-1, 1}) {
      const int row = i + di;
      int column = j + dj;
      if (grid.closed) column = (column + grid.columns) % grid.columns;
      if (row < 0 || row >= grid.rows || column < 0 || column >= grid.columns) continue;  // no face there
      const Vec3 warp = static_cast<double>(di) * (position.at(grid.index(row, j)) - here);
      const Vec3 weft = static_cast<double>(dj) * (position.at(grid.index(i, column)) - here);
      sum += 0.5 * warp.cross(weft);
    }
  }
  return sum;
}

TEST(NodeAreaVectors, AreTheSumOfTheCornerTrianglesOnAnyGrid) {
  Random random(3);
  for (const bool closed : {false, true}) {
    for (const int columns : {3, 7, 8, 9}) {
      const Grid grid(5, columns, closed);
      const Field3 position = randomPositions(grid, random, 1.0);
      Field3 vectors;
      vectors.assign(grid.size(), 0.0);
      nodeAreaVectors(grid, position, vectors);
      for (int i = 0; i < grid.rows; ++i) {
        for (int j = 0; j < grid.columns; ++j) {
          // Edges up to 2 sqrt(3) m, products up to 12 m^2, about ten roundings on either way.
          EXPECT_LE((vectors.at(grid.index(i, j)) - bruteForce(grid, position, i, j)).norm(), 20 * 12 * kEps)
              << i << ", " << j << (closed ? " closed" : "");
        }
      }
    }
  }
}

TEST(NodeAreaVectors, OfFlatClothAreTwiceTheNodesShareTimesTheNormal) {
  Scene scene = flatScene(5, 6, 1.0, 2.0);
  scene.cloth.row_spacing = {1.0, 2.0, 3.0, 1.0};
  scene.cloth.column_spacing = {1.0, 1.0, 4.0, 2.0, 2.0};
  const ClothPattern pattern = makePattern(scene);
  const ClothState state = makeInitialState(scene, pattern);
  Field3 vectors;
  vectors.assign(pattern.grid.size(), 0.0);
  nodeAreaVectors(pattern.grid, state.position, vectors);
  double total = 0.0;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 6; ++j) {
      const std::size_t n = pattern.grid.index(i, j);
      // Same normal as tilt turns towards: (to - from) x up = -y.
      EXPECT_LE((vectors.at(n) - 2.0 * pattern.area[n] * -Vec3::UnitY()).norm(), 32 * kEps) << i << ", " << j;
      total += vectors.at(n).norm();
    }
  }
  EXPECT_NEAR(total, 2.0 * 2.0, 30 * 32 * kEps) << "twice the cloth's 2 m^2";
}

TEST(NodeAreaVectors, OfARingPointOutwards) {
  const Scene scene = ringScene(4, 12);
  const ClothPattern pattern = makePattern(scene);
  const ClothState state = makeInitialState(scene, pattern);
  Field3 vectors;
  vectors.assign(pattern.grid.size(), 0.0);
  nodeAreaVectors(pattern.grid, state.position, vectors);
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 12; ++j) {
      const double angle = 2.0 * kPi * j / 12.0;
      const Vec3 normal = vectors.at(pattern.grid.index(i, j)).normalized();
      EXPECT_LE((normal - Vec3(std::cos(angle), std::sin(angle), 0.0)).norm(), 64 * kEps) << i << ", " << j;
    }
  }
}

TEST(NodeAreaVectors, OfAllNodesInOnePointAreZero) {
  const Grid grid(3, 3, false);
  Field3 position, vectors;
  position.assign(grid.size(), 0.7);
  vectors.assign(grid.size(), 1.0);
  nodeAreaVectors(grid, position, vectors);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) EXPECT_EQ(vectors.at(grid.index(i, j)), Vec3(0.0, 0.0, 0.0));
  }
}

}  // namespace
}  // namespace curtain
