// SPDX-License-Identifier: BSD-3-Clause
//
// The air's force by its relative velocity: the formula, its fixed points, and that it never turns a velocity around,
// however long the step.
#include "parts/air/relative_air.h"

#include <gtest/gtest.h>

#include <cmath>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;
using curtain_test::Random;
using curtain_test::randomPositions;

constexpr double kDensity = 1.2, kNormal = 1.3, kTangential = 0.1;

AirParams relativeLaw() {
  AirParams air;
  air.law = AirLaw::kRelative;
  air.density = kDensity;
  air.normal_drag = kNormal;
  air.tangential_drag = kTangential;
  return air;
}

ClothParams sheet(int rows, int columns, double porosity) {
  ClothParams cloth = flatScene(rows, columns).cloth;
  cloth.porosity = porosity;
  return cloth;
}

struct ClothInAir {
  explicit ClothInAir(double porosity = 0.0)
      : cloth(sheet(6, 5, porosity)), pattern(makePattern(flatScene(6, 5, 1.5, 0.8))), air(law, cloth, pattern) {
    const std::size_t size = pattern.grid.size();
    for (Field3* field : {&area_vectors, &wind, &velocity, &others, &pull}) field->assign(size, 0.0);
    position = makeInitialState(flatScene(6, 5, 1.5, 0.8), pattern).position;
    renew();
  }
  void renew() { nodeAreaVectors(pattern.grid, position, area_vectors); }
  Field3 force(const SubstepAhead& ahead = {}) {
    Field damping;
    ForceSum sum(damping);
    sum.ahead = ahead;
    sum.force = others;
    sum.air = wind;
    air.addForces({position, velocity, 0.0, {}, {}}, sum);
    for (std::size_t n = 0; n < pattern.grid.size(); ++n) sum.force.add(n, -others.at(n));
    return sum.force;
  }
  std::size_t middle() const { return pattern.grid.index(3, 2); }

  const AirParams law = relativeLaw();
  const ClothParams cloth;
  ClothPattern pattern;
  RelativeAir air;
  Field3 position, area_vectors, wind, velocity, others, pull;
};

TEST(RelativeAir, IsTheFormulaAtTheStartOfNoStep) {
  ClothInAir cloth(0.25);
  Random random(3);
  cloth.position = randomPositions(cloth.pattern.grid, random, 1.0);
  cloth.wind = randomPositions(cloth.pattern.grid, random, 9.0);
  cloth.velocity = randomPositions(cloth.pattern.grid, random, 4.0);
  cloth.renew();
  const Field3 force = cloth.force();
  for (int i = 0; i < cloth.pattern.grid.rows; ++i) {
    for (int j = 0; j < cloth.pattern.grid.columns; ++j) {
      const std::size_t n = cloth.pattern.grid.index(i, j);
      const Vec3 u = cloth.wind.at(n) - cloth.velocity.at(n), share = 0.5 * cloth.area_vectors.at(n);
      const Vec3 normal = share.normalized(), across = u.dot(normal) * normal;
      const Vec3 expected =
          0.5 * kDensity * u.norm() *
          (0.75 * kNormal * share.norm() * across + kTangential * cloth.pattern.area[n] * (u - across));
      EXPECT_LT((force.at(n) - expected).norm(), 32.0 * kEps * expected.norm()) << i << ", " << j;
    }
  }
}

// The node's share of the flat cloth, not twice that: the total is that of the whole sheet.
TEST(RelativeAir, LoadsAFlatSheetByItsWholeArea) {
  ClothInAir cloth;
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) cloth.wind.set(n, Vec3(0.0, 7.0, 0.0));
  const Field3 force = cloth.force();
  double sum = 0.0;
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) sum += force.y[n];
  EXPECT_NEAR(sum, 0.5 * kDensity * kNormal * 1.5 * 0.8 * 49.0, 1e-12);
}

TEST(RelativeAir, LeavesBalanceAloneAtAnyStep) {
  Random random(5);
  ClothInAir cloth;
  cloth.position = randomPositions(cloth.pattern.grid, random, 1.0);
  cloth.wind = randomPositions(cloth.pattern.grid, random, 9.0);
  cloth.velocity = randomPositions(cloth.pattern.grid, random, 4.0);
  cloth.renew();
  const Field3 air = cloth.force();
  // The links hold half of it, other forces the rest: nothing is left over.
  for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
    cloth.others.set(n, -0.5 * air.at(n));
    cloth.pull.set(n, -0.5 * cloth.pattern.inverse_mass[n] * air.at(n));
  }
  for (const double kick : {1e-4, 1e-2, 1.0, 100.0}) {
    for (const bool backward : {false, true}) {
      const Field3 force = cloth.force({kick, backward, &cloth.pull});
      for (std::size_t n = 0; n < cloth.pattern.grid.size(); ++n) {
        if (cloth.pattern.inverse_mass[n] <= 0.0) continue;
        EXPECT_LT((force.at(n) - air.at(n)).norm(), 1e-12 * (1.0 + air.at(n).norm())) << kick;
      }
    }
  }
}

TEST(RelativeAir, NeverTurnsARelativeVelocityAround) {
  Random random(7);
  ClothInAir cloth;
  cloth.wind = randomPositions(cloth.pattern.grid, random, 20.0);
  const std::size_t n = cloth.middle();
  const Vec3 normal = cloth.area_vectors.at(n).normalized(), u = cloth.wind.at(n);
  const double across = u.dot(normal), along = (u - across * normal).norm();
  for (double kick = 1e-6; kick < 1e7; kick *= 10.0) {
    for (const bool backward : {false, true}) {
      const Vec3 after = u - kick * cloth.pattern.inverse_mass[n] * cloth.force({kick, backward, nullptr}).at(n);
      const double share = after.dot(normal) / across;
      EXPECT_TRUE(share >= -1e-9 && share < 1.0) << share << " at " << kick;
      const Vec3 rest = after - after.dot(normal) * normal;
      EXPECT_GE(rest.dot(u - across * normal), -1e-9 * along * along) << kick;
      EXPECT_LE(rest.norm(), along * (1.0 + 1e-12)) << kick;
    }
  }
}

// v = V tanh(g t / V) of a plate that falls flat from rest.
TEST(RelativeAir, IsOfSecondOrderInTheFall) {
  ClothInAir cloth;
  const std::size_t n = cloth.middle();
  const double w = cloth.pattern.inverse_mass[n], g = 9.81;
  const double terminal = std::sqrt(2.0 * g / (w * kDensity * kNormal * cloth.pattern.area[n]));
  cloth.others.set(n, Vec3(0.0, -g / w, 0.0));
  const auto errorIn = [&](int steps) {
    const double kick = terminal / g / steps;
    cloth.velocity.assign(cloth.pattern.grid.size(), 0.0);
    for (int k = 0; k < steps; ++k) {
      cloth.velocity.y[n] += kick * (w * cloth.force({kick, false, nullptr}).y[n] - g);
    }
    return std::abs(cloth.velocity.y[n] + terminal * std::tanh(1.0)) / terminal;
  };
  const double coarse = errorIn(16), fine = errorIn(32);
  EXPECT_LT(fine, 1e-3);
  EXPECT_NEAR(std::log2(coarse / fine), 2.0, 0.15);
}

TEST(RelativeAir, IsInactiveUnderOtherLawsAndWithoutDrag) {
  const ClothPattern pattern = makePattern(flatScene(4, 3));
  const AirParams other, relative = relativeLaw();
  EXPECT_FALSE(RelativeAir(other, sheet(4, 3, 0.0), pattern).active());
  AirParams none = relative;
  none.normal_drag = none.tangential_drag = 0.0;
  EXPECT_FALSE(RelativeAir(none, sheet(4, 3, 0.0), pattern).active());
  EXPECT_TRUE(RelativeAir(relative, sheet(4, 3, 1.0), pattern).active()) << "all pores: friction is left";
}

}  // namespace
}  // namespace curtain
