// SPDX-License-Identifier: BSD-3-Clause
//
// Points all over the cloth: their number is area times density, every triangle has its share, and each lies where its
// coordinates on the flat cloth say.
#include "sensing/cloth_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "testing.h"

namespace curtain {
namespace {

FlatCloth flatOf(const Simulator& simulator) {
  std::vector<double> warp, weft;
  simulator.copyRestLengths(warp, weft);
  return {simulator.fineMeshTopology(), warp, weft};
}

std::vector<CloudPoint> cloudOf(const Simulator& simulator, double density, std::uint64_t seed = 1) {
  const FlatCloth flat = flatOf(simulator);
  Moment moment;
  readMoment(simulator, moment);
  std::vector<CloudPoint> cloud;
  ClothSampler(flat, density, seed).sample(moment, cloud);
  return cloud;
}

TEST(ClothSampler, HasTheDensityAskedFor) {
  Scene tapered = curtain_test::flatScene(7, 6);
  tapered.cloth.hem_width = 1.4;
  tapered.cloth.folds = 4;
  EXPECT_NEAR(flatOf(Simulator(tapered)).area(), 1.2, 1e-12) << "a trapezoid";
  EXPECT_EQ(cloudOf(Simulator(tapered), 5000.0).size(), 6000U);
  EXPECT_NEAR(flatOf(Simulator(curtain_test::ringScene(7, 8, 1.0, 2.0))).area(), 2.0, 1e-12);
  Scene cut = curtain_test::flatScene(5, 11);
  cut.cloth.slits = {{4, 0}};  // one of ten links, all the way down
  EXPECT_NEAR(flatOf(Simulator(cut)).area(), 0.9, 1e-12);
  EXPECT_TRUE(cloudOf(Simulator(cut), 0.1).empty());
}

// Strata of equal area, one point each: a region of whole triangles has its share but for one point at either end of
// each run of them. Quads of a row follow each other, so a column of quads, in 20 rows, has 20 runs.
TEST(ClothSampler, GivesEveryPlaceItsShare) {
  Scene scene = curtain_test::flatScene(21, 11);
  scene.cloth.folds = 3;
  const double density = 40000.0;
  std::map<int, int> rows, columns;
  for (const CloudPoint& point : cloudOf(Simulator(scene), density)) {
    ++rows[static_cast<int>(point.v / 0.05F)];
    ++columns[static_cast<int>(point.u / 0.1F)];
  }
  ASSERT_EQ(rows.size(), 20U);
  ASSERT_EQ(columns.size(), 10U);
  for (const auto& [row, count] : rows) EXPECT_NEAR(count, 0.05 * density, 2.0) << row;
  for (const auto& [column, count] : columns) EXPECT_NEAR(count, 0.1 * density, 2.0 * 20.0) << column;
}

// Hung flat, the cloth is its own map.
TEST(ClothSampler, PutsPointsWhereTheirCoordinatesAre) {
  const Simulator simulator(curtain_test::flatScene(6, 5));  // in the plane y = 0, from (0, 0, 1) along x
  const std::vector<CloudPoint> cloud = cloudOf(simulator, 20000.0);
  double mean_u = 0.0, mean_v = 0.0;
  for (const CloudPoint& point : cloud) {
    ASSERT_NEAR(point.x, point.u, 1e-6F);
    ASSERT_NEAR(point.y, 0.0F, 1e-6F);
    ASSERT_NEAR(point.z, 1.0F - point.v, 1e-6F);
    ASSERT_NEAR(std::abs(point.normal_y), 1.0F, 1e-6F);
    ASSERT_EQ(point.speed, 0.0F);
    // The nearest node, to what rounding can decide.
    const int row = point.node / 5, column = point.node % 5;
    ASSERT_LE(std::abs(point.u - 0.25 * column), 0.125 + 1e-6);
    ASSERT_LE(std::abs(point.v - 0.2 * row), 0.1 + 1e-6);
    mean_u += point.u / static_cast<double>(cloud.size());
    mean_v += point.v / static_cast<double>(cloud.size());
  }
  // Of n independent uniform points the mean has the deviation sqrt(1/12/n), of strata less: five of them.
  const double slack = 5.0 * std::sqrt(1.0 / 12.0 / static_cast<double>(cloud.size()));
  EXPECT_NEAR(mean_u, 0.5, slack);
  EXPECT_NEAR(mean_v, 0.5, slack);
}

TEST(ClothSampler, IsTheSameForTheSameSeed) {
  const Simulator simulator(curtain_test::flatScene(6, 5));
  const std::vector<CloudPoint> one = cloudOf(simulator, 1000.0), again = cloudOf(simulator, 1000.0),
                                other = cloudOf(simulator, 1000.0, 2);
  ASSERT_EQ(one.size(), again.size());
  EXPECT_EQ(std::memcmp(one.data(), again.data(), one.size() * sizeof(CloudPoint)), 0);
  ASSERT_EQ(one.size(), other.size());
  EXPECT_NE(std::memcmp(one.data(), other.data(), one.size() * sizeof(CloudPoint)), 0);
}

// Of closed cloth the last link leads back to column 0: its coordinate goes on, its node does not.
TEST(ClothSampler, GoesRoundClosedCloth) {
  const Simulator simulator(curtain_test::ringScene(4, 8, 1.0, 2.0));
  float largest = 0.0F;
  for (const CloudPoint& point : cloudOf(simulator, 5000.0)) {
    largest = std::max(largest, point.u);
    ASSERT_LT(point.node, 32);
    if (point.u > 1.876F) {
      ASSERT_EQ(point.node % 8, 0);
    }
  }
  EXPECT_GT(largest, 1.9F);
  EXPECT_LE(largest, 2.0F);
}

}  // namespace
}  // namespace curtain
