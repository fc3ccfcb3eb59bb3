// SPDX-License-Identifier: BSD-3-Clause
//
// The gusts of a wind source: their own for each id and seed, of the size that was asked for.
#include <gtest/gtest.h>

#include <cmath>

#include "parts/wind_on_cloth.h"

namespace curtain {
namespace {

using namespace curtain_test;

WindParams gusts(const std::string& id) {
  WindParams wind;
  wind.id = id;
  wind.position = {0.5, 0.0, 0.5};
  wind.direction = Vec3::UnitY();
  wind.radius = 5.0;
  wind.unsteadiness = 2.0;
  return wind;
}

// Sum over nodes and times of the product of two sources' gusts over the geometric mean of their squares.
double likeness(const WindParams& one, std::uint64_t seed_one, const WindParams& other, std::uint64_t seed_other) {
  const WindyCloth cloth(flatScene(9, 9));
  const ClothParams dense = porous(cloth.pattern, 0.0);
  WindSource a(one, cloth.pattern, dense, seed_one), b(other, cloth.pattern, dense, seed_other);
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (int sample = 0; sample < 500; ++sample) {
    const double time = 2.1 * sample * one.correlation_time;
    const Field3 fa = cloth.push(a, time), fb = cloth.push(b, time);
    for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
      ab += fa.at(n).dot(fb.at(n));
      aa += fa.at(n).squaredNorm();
      bb += fb.at(n).squaredNorm();
    }
  }
  return ab / std::sqrt(aa * bb);
}

TEST(WindGusts, RepeatWithIdAndSeedAndAreTheirOwnOtherwise) {
  // 500 independent times x 3 components x at least one independent patch: 1/sqrt(1500) = 0.026 standard deviation.
  EXPECT_NEAR(likeness(gusts("a"), 1, gusts("a"), 1), 1.0, 1e-12);
  EXPECT_NEAR(likeness(gusts("a"), 1, gusts("b"), 1), 0.0, 5 * 0.026);
  EXPECT_NEAR(likeness(gusts("a"), 1, gusts("a"), 2), 0.0, 5 * 0.026);
  EXPECT_NEAR(likeness(gusts("fan"), 1, gusts("fan2"), 1), 0.0, 5 * 0.026);
}

TEST(WindGusts, StartWithTheSource) {
  const WindyCloth cloth(flatScene(4, 4));
  WindParams wind = gusts("a");
  WindSource early(wind, cloth.pattern, porous(cloth.pattern, 0.0), 1);
  wind.start = 8.0;
  WindSource late(wind, cloth.pattern, porous(cloth.pattern, 0.0), 1);
  const Field3 a = cloth.push(early, 0.375), b = cloth.push(late, 8.375);  // exact in binary
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) EXPECT_EQ(a.at(n), b.at(n));
}

TEST(WindGusts, AreTheUnsteadinessInPascalOnTheNodesArea) {
  const WindyCloth cloth(flatScene(9, 9));
  WindSource source(gusts("a"), cloth.pattern, porous(cloth.pattern, 0.0), 1);
  double sum = 0.0;
  int count = 0;
  for (int sample = 0; sample < 2000; ++sample) {
    const Field3 force = cloth.push(source, 2.1 * sample * 0.2);
    for (const auto& [i, j] : {std::pair{0, 0}, std::pair{4, 4}, std::pair{8, 3}}) {
      const std::size_t n = cloth.pattern.grid.index(i, j);
      sum += (force.at(n) / (2.0 * cloth.pattern.area[n])).squaredNorm();
      count += 3;
    }
  }
  // Variance 1 a component; 2000 independent times x 3 components x 3 nodes more than a correlation length apart.
  EXPECT_NEAR(sum / count, 1.0, 5.0 * std::sqrt(2.0 / count));
}

}  // namespace
}  // namespace curtain
