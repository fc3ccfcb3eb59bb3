// SPDX-License-Identifier: BSD-3-Clause
//
// What a rail does to its carriers: the convex problem of rail_law.h is solved exactly, and its parts are what they are
// in mechanics.
#include "parts/rail/rail_law.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "testing.h"

namespace curtain {
namespace {

constexpr double kGap = 0.1;
constexpr double kRailLength = 3.0;

RailRow rowOf(double mass, double wish) {
  RailRow row;
  row.mass = mass;
  row.wish = wish;
  return row;
}

double objective(const std::vector<RailRow>& rows, const std::vector<double>& s) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RailRow& row = rows[i];
    sum +=
        0.5 * row.mass * (s[i] - row.wish) * (s[i] - row.wish) + row.friction.bound * std::abs(s[i] - row.friction.at);
    sum += row.drive.bound * std::abs(s[i] - row.drive.at);
  }
  return sum;
}

std::vector<double> placesOf(const std::vector<RailRow>& rows) {
  std::vector<double> places;
  for (const RailRow& row : rows) places.push_back(row.place);
  return places;
}

void expectInOrder(const std::vector<double>& s) {
  constexpr double kRounding = 1e-14;
  EXPECT_GE(s.front(), 0.0);
  EXPECT_LE(s.back(), kRailLength + kRounding);
  for (std::size_t i = 1; i < s.size(); ++i) EXPECT_GE(s[i] - s[i - 1], kGap - kRounding);
}

// Moved a little in any way that the order allows, the sum never gets smaller. The problem is convex, so its solution
// is the one place where that is so.
TEST(RailLaw, FindsTheLeastOfItsSum) {
  curtain_test::Random random(7);
  const auto between = [&](double low, double high) { return random.between(low, high); };
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<RailRow> rows;
    const int count = 1 + trial % 9;
    for (int i = 0; i < count; ++i) {
      rows.push_back(rowOf(between(0.1, 2.0), between(-0.3, kRailLength + 0.3)));
      const double was = kGap * i + between(0.0, 0.2);
      rows.back().friction = {was, trial % 3 == 0 ? 0.0 : between(0.0, 1.0)};
      if (i % 4 == 3) rows.back().drive = {was + between(-0.2, 0.2), between(0.0, 2.0)};
    }
    RailLaw law(rows.size(), kGap, kRailLength);
    law.solve(rows.data());
    const std::vector<double> s = placesOf(rows);
    expectInOrder(s);
    const double least = objective(rows, s);
    for (int look = 0; look < 200; ++look) {
      const double size = std::pow(10.0, between(-6.0, -1.0));
      std::vector<double> other = s;
      for (double& place : other) place += size * between(-1.0, 1.0);
      // Into the order again: by sorting what the gaps are taken off.
      for (std::size_t i = 0; i < other.size(); ++i) other[i] -= kGap * static_cast<double>(i);
      std::sort(other.begin(), other.end());
      const double most = kRailLength - kGap * static_cast<double>(other.size() - 1);
      for (std::size_t i = 0; i < other.size(); ++i)
        other[i] = std::clamp(other[i], 0.0, most) + kGap * static_cast<double>(i);
      ASSERT_GE(objective(rows, other), least - 1e-12) << "trial " << trial << " look " << look;
    }
  }
}

TEST(RailLaw, PushedCarriersMoveAsOneBodyAndKeepTheMomentum) {
  std::vector<RailRow> rows = {rowOf(1.0, 1.5), rowOf(2.0, 1.1), rowOf(3.0, 1.2)};
  RailLaw(rows.size(), kGap, kRailLength).solve(rows.data());
  expectInOrder(placesOf(rows));
  double before = 0.0, after = 0.0;
  for (const RailRow& row : rows) {
    before += row.mass * row.wish;
    after += row.mass * row.place;
    EXPECT_FALSE(row.stays);
  }
  EXPECT_NEAR(after, before, 1e-14);
  EXPECT_DOUBLE_EQ(rows[2].place - rows[0].place, 2.0 * kGap);
}

TEST(RailLaw, CarriersStayToTheBitUntilFrictionIsOvercome) {
  std::vector<RailRow> rows = {rowOf(2.0, 0.0)};
  const double was = 1.0 / 3.0;
  RailLaw law(1, kGap, kRailLength);
  rows[0].friction = {was, 0.5};
  rows[0].wish = was + 0.2499;
  law.solve(rows.data());
  EXPECT_EQ(rows[0].place, was);
  EXPECT_TRUE(rows[0].stays);
  rows[0].wish = was + 0.2501;
  law.solve(rows.data());
  EXPECT_NEAR(rows[0].place, was + 0.0001, 1e-15);
  EXPECT_FALSE(rows[0].stays);
}

TEST(RailLaw, AFastenedCarrierStopsAllThatPushIt) {
  std::vector<RailRow> rows = {rowOf(1.0, 0.9), rowOf(1.0, 0.95), rowOf(1.0, 0.97)};
  rows[0].friction = {0.5, 0.0};
  rows[1].friction = {1.0 / 3.0, std::numeric_limits<double>::infinity()};
  RailLaw(rows.size(), kGap, kRailLength).solve(rows.data());
  EXPECT_EQ(rows[1].place, 1.0 / 3.0);
  EXPECT_DOUBLE_EQ(rows[0].place, 1.0 / 3.0 - kGap);
  EXPECT_TRUE(rows[0].stays);
  EXPECT_EQ(rows[2].place, 0.97);
}

TEST(RailLaw, TheDriveArrivesIfItsForceIsEnough) {
  std::vector<RailRow> rows = {rowOf(2.0, 1.0)};
  RailLaw law(1, kGap, kRailLength);
  rows[0].drive = {1.5, 1.5};  // it needs 1
  law.solve(rows.data());
  EXPECT_EQ(rows[0].place, 1.5);
  EXPECT_DOUBLE_EQ(rows[0].drawn, 1.0);
  rows[0].drive.bound = 0.5;
  law.solve(rows.data());
  EXPECT_DOUBLE_EQ(rows[0].place, 1.25);
  EXPECT_DOUBLE_EQ(rows[0].drawn, 0.5);
}

TEST(RailLaw, TheDriveCarriesWhatFrictionDoesNot) {
  std::vector<RailRow> rows = {rowOf(2.0, 0.9)};
  rows[0].friction = {1.0, 0.15};
  rows[0].drive = {1.0, 5.0};  // it is where it is to be, and 0.2 kg m pull it back
  RailLaw(1, kGap, kRailLength).solve(rows.data());
  EXPECT_EQ(rows[0].place, 1.0);
  EXPECT_NEAR(rows[0].drawn, 0.05, 1e-15);
}

}  // namespace
}  // namespace curtain
