// SPDX-License-Identifier: BSD-3-Clause
//
// Gusts are a field of mean 0 and variance 1 in place and time, correlated over the length and the time given and not
// beyond, a function of seed, place and time alone.
//
// Statistics of N independent numbers: the mean is within 5/sqrt(N) of 0, the variance within 5 sqrt(2/N) of 1 (no
// heavier tails than the normal's), a correlation within 5/sqrt(N): five standard deviations, for seeds that are fixed.
#include "parts/wind/gust_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::kEps;
using curtain_test::ringScene;

struct Moments {
  double mean = 0.0, variance = 0.0;
  double count = 0.0;
};

Moments moments(int count, const std::function<double(int)>& number) {
  double sum = 0.0, squares = 0.0;
  for (int n = 0; n < count; ++n) {
    const double x = number(n);
    sum += x;
    squares += x * x;
  }
  return {sum / count, squares / count, static_cast<double>(count)};
}

void expectStandard(const Moments& m, const std::string& what) {
  EXPECT_NEAR(m.mean, 0.0, 5.0 / std::sqrt(m.count)) << what;
  EXPECT_NEAR(m.variance, 1.0, 5.0 * std::sqrt(2.0 / m.count)) << what;
}

TEST(HashedNormal, HasMean0AndVariance1AlongEveryArgument) {
  constexpr int kCount = 100000;
  expectStandard(moments(kCount, [](int n) { return hashedNormal(7, n, 1, 2); }), "a");
  expectStandard(moments(kCount, [](int n) { return hashedNormal(7, 1, n, 2); }), "b");
  expectStandard(moments(kCount, [](int n) { return hashedNormal(7, 1, 2, n); }), "c");
  expectStandard(moments(kCount, [](int n) { return hashedNormal(static_cast<std::uint64_t>(n), 1, 2, 3); }), "seed");
  expectStandard(moments(kCount, [](int n) { return hashedNormal(7, -n, -1, -n); }), "negative");
}

TEST(HashedNormal, NeighboursAreUncorrelated) {
  constexpr int kCount = 100000;
  const double bound = 5.0 / std::sqrt(static_cast<double>(kCount));
  const auto here = [](int n) { return hashedNormal(7, n % 100, n / 100 % 3, n / 300); };
  const auto product = [&](const std::function<double(int)>& other) {
    return moments(kCount, [&](int n) { return here(n) * other(n); }).mean;
  };
  EXPECT_NEAR(product([](int n) { return hashedNormal(7, n % 100 + 1, n / 100 % 3, n / 300); }), 0.0, bound);
  EXPECT_NEAR(product([](int n) { return hashedNormal(7, n % 100, n / 100 % 3 + 1, n / 300); }), 0.0, bound);
  EXPECT_NEAR(product([](int n) { return hashedNormal(7, n % 100, n / 100 % 3, n / 300 + 1); }), 0.0, bound);
  EXPECT_NEAR(product([](int n) { return hashedNormal(8, n % 100, n / 100 % 3, n / 300); }), 0.0, bound);
}

constexpr double kTime = 0.2;          // [s] correlation time
constexpr double kNoiseLength = 0.25;  // [m] correlation length
constexpr int kSamples = 20000;

// Times more than two correlation times apart at every phase: independent.
double sampleTime(int n) { return (2.0 + 0.6180339887498949) * kTime * n; }

struct Sheet {
  explicit Sheet(const Scene& scene, std::uint64_t seed = 5, double length = kNoiseLength)
      : pattern(makePattern(scene)), gusts(seed, length, kTime, pattern) {}
  ClothPattern pattern;
  GustNoise gusts;
};

TEST(GustNoise, HasMean0AndVariance1Everywhere) {
  Sheet sheet(flatScene(11, 11));
  const std::pair<int, int> nodes[] = {{0, 0}, {5, 5}, {10, 10}, {1, 9}, {4, 3}};
  for (const auto& [i, j] : nodes) {
    for (int axis = 0; axis < 3; ++axis) {
      const Moments m = moments(kSamples, [&, row = i, column = j](int n) {
        sheet.gusts.setTime(sampleTime(n));
        return sheet.gusts.at(row, column)[axis];
      });
      expectStandard(m, "node " + std::to_string(i) + ", " + std::to_string(j) + " axis " + std::to_string(axis));
    }
  }
}

// A row at once is the field node by node; only the order of the four products differs, each at most some 4 in size.
TEST(GustNoise, GivesARowAsItsNodes) {
  for (const bool closed : {false, true}) {
    Sheet sheet(closed ? ringScene(7, 16) : flatScene(7, 16));
    sheet.gusts.setTime(0.37);
    std::vector<double> row(16);
    for (int i = 0; i < 7; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        sheet.gusts.rowOf(i, axis, row.data());
        for (int j = 0; j < 16; ++j) {
          EXPECT_NEAR(row[static_cast<std::size_t>(j)], sheet.gusts.at(i, j)[axis], 4.0 * 8.0 * kEps) << i << ", " << j;
        }
      }
    }
  }
}

TEST(GustNoise, HasVariance1AllAroundARing) {
  // A ring of one correlation length or less is the narrow case: its lattice closes upon itself.
  for (const double around : {1.0, 0.5, 0.4, 0.2}) {
    Sheet sheet(ringScene(3, 8, 1.0, around));
    for (const int j : {0, 1, 2, 4, 7}) {
      const Moments m = moments(kSamples, [&](int n) {
        sheet.gusts.setTime(sampleTime(n));
        return sheet.gusts.at(1, j).x();
      });
      expectStandard(m, "column " + std::to_string(j) + " of a ring of " + std::to_string(around) + " m");
    }
  }
}

// Mean over many places in time of the product of the gusts a lag apart.
double timeCorrelation(Sheet& sheet, double lag) {
  return moments(kSamples,
                 [&](int n) {
                   const double t = sampleTime(n) * 3.0;  // the pairs too must be independent: longest lag 3 tau
                   sheet.gusts.setTime(t);
                   const Vec3 now = sheet.gusts.at(3, 3);
                   sheet.gusts.setTime(t + lag);
                   return now.dot(sheet.gusts.at(3, 3)) / 3.0;
                 })
      .mean;
}

TEST(GustNoise, ForgetsAfterItsCorrelationTime) {
  // The correlation time is where the correlation has fallen past 1/e = 0.37, and half of it where it has not yet.
  Sheet sheet(flatScene(11, 11));
  const double slack = 5.0 / std::sqrt(static_cast<double>(kSamples));
  const double at_0 = timeCorrelation(sheet, 0.0);
  const double at_half = timeCorrelation(sheet, 0.5 * kTime);
  const double at_1 = timeCorrelation(sheet, kTime);
  EXPECT_NEAR(at_0, 1.0, 5.0 * std::sqrt(2.0 / kSamples));
  EXPECT_GT(at_half, 1.0 / std::exp(1.0) + slack);
  EXPECT_LT(at_half, 0.95);
  EXPECT_LT(at_1, 1.0 / std::exp(1.0));
  EXPECT_GT(at_1, -slack);
  EXPECT_NEAR(timeCorrelation(sheet, 2.0 * kTime), 0.0, slack);
  EXPECT_NEAR(timeCorrelation(sheet, 3.0 * kTime), 0.0, slack);
  // A short lag changes little: the field is continuous. Its rate is at most about 3/tau.
  EXPECT_GT(timeCorrelation(sheet, 0.01 * kTime), 1.0 - 0.03 - 5.0 * std::sqrt(2.0 / kSamples));
}

TEST(GustNoise, ForgetsBeyondItsCorrelationLength) {
  // Along rows and along columns, over 2 m of cloth: 81 nodes 25 mm apart.
  Sheet sheet(flatScene(81, 81, 2.0, 2.0));
  const double slack = 5.0 / std::sqrt(static_cast<double>(kSamples));
  const auto correlation = [&](int rows, int columns) {
    return moments(kSamples,
                   [&](int n) {
                     sheet.gusts.setTime(sampleTime(n));
                     const int i = n * 7 % 45, j = n * 11 % 45;
                     return sheet.gusts.at(i, j).dot(sheet.gusts.at(i + rows, j + columns)) / 3.0;
                   })
        .mean;
  };
  EXPECT_NEAR(correlation(0, 0), 1.0, 5.0 * std::sqrt(2.0 / kSamples));
  for (const auto& [down, along] : {std::pair{1, 0}, std::pair{0, 1}}) {
    EXPECT_GT(correlation(5 * down, 5 * along), 1.0 / std::exp(1.0)) << "half a length";
    EXPECT_LT(correlation(10 * down, 10 * along), 1.0 / std::exp(1.0)) << "one length";
    EXPECT_NEAR(correlation(20 * down, 20 * along), 0.0, slack) << "two lengths";
    EXPECT_NEAR(correlation(30 * down, 30 * along), 0.0, slack) << "three lengths";
  }
}

TEST(GustNoise, ComponentsAreIndependent) {
  Sheet sheet(flatScene(11, 11));
  for (int axis = 0; axis < 3; ++axis) {
    const double product = moments(kSamples, [&](int n) {
                             sheet.gusts.setTime(sampleTime(n));
                             const Vec3 gust = sheet.gusts.at(3, 3);
                             return gust[axis] * gust[(axis + 1) % 3];
                           }).mean;
    EXPECT_NEAR(product, 0.0, 5.0 / std::sqrt(static_cast<double>(kSamples)));
  }
}

TEST(GustNoise, IsAFunctionOfSeedPlaceAndTimeAlone) {
  Sheet one(flatScene(9, 9)), other(flatScene(9, 9)), foreign(flatScene(9, 9), 6);
  other.gusts.setTime(77.0);
  other.gusts.setTime(0.1);
  one.gusts.setTime(3.3);
  other.gusts.setTime(3.3);
  foreign.gusts.setTime(3.3);
  for (int i = 0; i < 9; ++i) {
    for (int j = 0; j < 9; ++j) {
      EXPECT_EQ(one.gusts.at(i, j), other.gusts.at(8 - (8 - i), j)) << "whatever was asked before";
      EXPECT_NE(one.gusts.at(i, j), foreign.gusts.at(i, j));
    }
  }
}

TEST(GustNoise, IsContinuousAcrossItsLatticeTimes) {
  Sheet sheet(flatScene(9, 9));
  for (int slab = 1; slab < 20; ++slab) {
    // Rate below 6 x |n| / tau with |n| <= 2 sqrt(3) a component and lattice point, four points: 1e-9 of tau is 1e-7.
    sheet.gusts.setTime(kTime * slab * (1.0 - 1e-9));
    const Vec3 before = sheet.gusts.at(4, 4);
    sheet.gusts.setTime(kTime * slab * (1.0 + 1e-9));
    EXPECT_LE((sheet.gusts.at(4, 4) - before).norm(), 20 * 2e-9 * 6.0 * 3.5 * 4.0);
  }
}

void expectSameOnBothGrids(double length) {
  Sheet coarse(flatScene(9, 9), 5, length), fine(flatScene(81, 41), 5, length);
  for (const double time : {0.0, 0.123, 5.4321}) {
    coarse.gusts.setTime(time);
    fine.gusts.setTime(time);
    for (int i = 0; i < 9; ++i) {
      for (int j = 0; j < 9; ++j) {
        // Places differ by rounding (a few eps of 4 cells); weights change by at most 3 a cell, numbers are below 3.5.
        ASSERT_LE((coarse.gusts.at(i, j) - fine.gusts.at(10 * i, 5 * j)).norm(), 80 * 4 * kEps * 3.0 * 3.5 * 4.0)
            << "correlation length " << length;
      }
    }
  }
}

TEST(GustNoise, IsTheSameOnEveryGridThatResolvesIt) {
  expectSameOnBothGrids(0.3);
  expectSameOnBothGrids(0.7);
}

// The cloth's 1 m are the sum of its rods, rounded: whether that is a hair over four lengths must not make a fifth
// cell.
TEST(GustNoise, IsTheSameOnEveryGridWhereTheLengthDividesTheCloth) {
  expectSameOnBothGrids(0.25);
  expectSameOnBothGrids(0.5);
}

TEST(GustNoise, IsContinuousAroundARing) {
  Sheet sheet(ringScene(3, 400, 1.0, 1.0));
  for (int n = 0; n < 50; ++n) {
    sheet.gusts.setTime(sampleTime(n));
    for (int j = 0; j < 400; ++j) {
      // Columns are 1/100 of a cell apart; weights change by at most 3 a cell, numbers are below 2 sqrt(3), a vector
      // has three of them, and two lattice points weigh in along each of the two ways (at most sqrt(2) times the
      // number).
      const double step = (sheet.gusts.at(1, j) - sheet.gusts.at(1, (j + 1) % 400)).norm();
      ASSERT_LE(step, 0.01 * 3.0 * 3.5 * std::sqrt(3.0) * 2.0 * std::sqrt(2.0)) << "column " << j;
    }
  }
}

}  // namespace
}  // namespace curtain
