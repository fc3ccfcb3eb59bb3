// SPDX-License-Identifier: BSD-3-Clause
//
// Continuous collision detection: no impact is missed or told late, few are told that are none.
#include "curtain_sim/ccd.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "contact/ccd_oracle.h"
#include "testing.h"
#include "truth_table.h"

namespace {

using curtain::Vec3;
using curtain_test::CcdPoints;
using curtain_test::CcdQuery;
using curtain_test::distanceAt;
using curtain_test::minDistance;
using curtain_test::Random;
using curtain_test::readCcdQueries;
using curtain_test::Real;
using curtain_test::timeOfImpact;

struct Count {
  int queries = 0;
  int hits = 0;
  int missed = 0;
  int false_alarms = 0;
};

Count judge(const std::vector<CcdQuery>& queries, bool edges) {
  Count count;
  for (const CcdQuery& query : queries) {
    if (query.edges != edges) continue;
    const bool told = timeOfImpact(edges, query.points).has_value();
    ++count.queries;
    if (query.hit) ++count.hits;
    if (query.hit && !told) ++count.missed;
    if (!query.hit && told) ++count.false_alarms;
  }
  return count;
}

// Handcrafted to touch, graze and lie in one plane. The false alarms that are left go by at a few roundings.
TEST(CcdTruth, MissesNoHandcraftedImpact) {
  const auto queries = readCcdQueries("queries.bin");
  const Count triangles = judge(queries, false);
  EXPECT_EQ(triangles.queries, 3085);
  EXPECT_EQ(triangles.hits, 248);
  EXPECT_EQ(triangles.missed, 0);
  EXPECT_LE(triangles.false_alarms, 51);
  const Count edges = judge(queries, true);
  EXPECT_EQ(edges.queries, 4194);
  EXPECT_EQ(edges.hits, 187);
  EXPECT_EQ(edges.missed, 0);
  EXPECT_LE(edges.false_alarms, 89);
}

TEST(CcdTruth, TellsEveryQueryOfClothRight) {
  const auto queries = readCcdQueries("queries_cloth.bin");
  for (const bool edges : {false, true}) {
    const Count count = judge(queries, edges);
    EXPECT_EQ(count.queries, edges ? 5198 : 4656);
    EXPECT_EQ(count.hits, edges ? 1030 : 603);
    EXPECT_EQ(count.missed, 0);
    EXPECT_EQ(count.false_alarms, 0);
  }
}

TEST(CcdTruth, IsNeverLaterThanTheExactTime) {
  const auto queries = readCcdQueries("queries.bin");
  std::vector<long double> early;
  for (const auto& row : curtain_test::readTruth("ccd/toi.csv")) {
    const CcdQuery& query = queries[std::stoul(row.at("index"))];
    ASSERT_TRUE(query.hit);
    CcdPoints mirrored = query.points;
    for (Vec3& point : mirrored) point = -point;
    for (const CcdPoints& points : {query.points, mirrored}) {
      const auto told = timeOfImpact(query.edges, points);
      ASSERT_TRUE(told.has_value()) << row.at("index");
      EXPECT_GE(*told, 0.0);
      early.push_back(std::stold(row.at("toi")) - static_cast<long double>(*told));
      EXPECT_GE(early.back(), 0.0L) << row.at("index");
    }
  }
  ASSERT_EQ(early.size(), 2u * 435u);
  std::sort(early.begin(), early.end());
  EXPECT_LT(early[early.size() / 2], 1e-14L);
  EXPECT_LT(early[early.size() * 98 / 100], 1e-11L);  // the others slide along each other at a few roundings first
}

/// Elements of about a metre around the origin, every corner of which wanders by up to `turning`, the first of the two
/// (a vertex or an edge) on a flight of 3 m past the other: some touch, some pass.
CcdPoints randomQuery(Random& random, bool edges, double turning) {
  CcdPoints x;
  const Vec3 half_flight = 1.5 * random.direction();
  for (std::size_t i = 0; i < 4; ++i) {
    x[i] = random.inBox(1.0);
    x[i + 4] = x[i] + random.inBox(turning);
    if (i > (edges ? 1u : 0u)) continue;
    x[i] -= half_flight;
    x[i + 4] += half_flight;
  }
  return x;
}

/// What must hold for any query: before the told time they are further apart, at it no more than by roundings of
/// metres.
void expectTrue(bool edges, const CcdPoints& x, double min_distance, int& told_hits) {
  constexpr Real kClose = 1e-13L;
  const auto told = timeOfImpact(edges, x, min_distance);
  if (told) {
    ++told_hits;
    ASSERT_GE(*told, 0.0);
    ASSERT_LE(*told, 1.0);
    ASSERT_LE(distanceAt(edges, x, static_cast<Real>(*told)), static_cast<Real>(min_distance) + kClose);
    if (*told == 0.0) return;
  }
  ASSERT_GT(minDistance(edges, x, told ? static_cast<Real>(*told) : 1.0L, 60), static_cast<Real>(min_distance));
}

TEST(CcdOracle, AgreesOnRandomQueries) {
  Random random(5);
  int hits = 0;
  constexpr int kQueries = 3000;
  for (int k = 0; k < kQueries; ++k) {
    const bool edges = k % 2 == 1;
    const double turning = std::array<double, 3>{0.0, 0.3, 2.0}[static_cast<std::size_t>(k / 2 % 3)];
    const double min_distance = std::array<double, 4>{0.0, 1e-3, 0.02, 0.2}[static_cast<std::size_t>(k / 6 % 4)];
    const CcdPoints x = randomQuery(random, edges, turning);
    SCOPED_TRACE("query " + std::to_string(k));
    expectTrue(edges, x, min_distance, hits);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(hits, kQueries / 10);
  EXPECT_LT(hits, kQueries * 9 / 10);
}

// Points and weights are drawn, then the motion that makes them meet at a drawn time.
TEST(CcdOracle, ConstructedImpactsAreNeitherMissedNorLate) {
  Random random(6);
  for (int k = 0; k < 20000; ++k) {
    const double t = random.between(0.01, 0.99);
    const bool edges = k % 2 == 1;
    CcdPoints x;
    for (std::size_t i = 0; i < 8; ++i) x[i] = random.inBox(1.0);
    const auto at = [&](std::size_t i) -> Vec3 { return (1.0 - t) * x[i] + t * x[i + 4]; };
    const double u = random.between(0.05, 0.45);
    const double v = random.between(0.05, 0.45);
    const Vec3 meet =
        edges ? Vec3(u * at(1) - at(2) + v * (at(2) - at(3))) : Vec3(-(1.0 - u - v) * at(1) - u * at(2) - v * at(3));
    // The first point's end, so that its weighted sum with the others is zero at t.
    const double weight = edges ? 1.0 - u : 1.0;
    x[4] = (-meet / weight - (1.0 - t) * x[0]) / t;
    const auto told = timeOfImpact(edges, x);
    ASSERT_TRUE(told.has_value()) << k;
    ASSERT_LE(*told, t + 1e-11) << k;
  }
}

// Whole numbers of some 40 bits, so that nothing rounds here and everything does there: the two touch at t = 1 exactly.
TEST(CcdOracle, ExactTouchesAtTheEndAreNotMissed) {
  Random random(12);
  const auto whole = [&random]() -> Vec3 { return 4.0 * random.inBox(0x1.0p38).array().floor().matrix(); };
  for (int k = 0; k < 20000; ++k) {
    const bool edges = k % 2 == 1;
    CcdPoints x;
    for (Vec3& point : x) point = whole();
    const Vec3 ab = 0.25 * (x[5] - x[4]);
    if (edges) {  // c-d goes through a point of a-b
      const Vec3 meet = x[4] + std::floor(random.between(0.0, 5.0)) * ab;
      x[7] = x[6] + std::floor(random.between(1.0, 4.0)) * (meet - x[6]);
    } else {
      const double b = std::floor(random.between(0.0, 5.0));
      const double c = std::floor(random.between(0.0, 5.0 - b));
      x[4] = x[5] + 0.25 * (b * (x[6] - x[5]) + c * (x[7] - x[5]));
    }
    ASSERT_TRUE(timeOfImpact(edges, x).has_value()) << k;
  }
}

TEST(CcdSymmetry, OrderPlaceAndScaleDoNotMatter) {
  Random random(7);
  for (int k = 0; k < 2000; ++k) {
    const bool edges = k % 2 == 1;
    const CcdPoints x = randomQuery(random, edges, 0.5);
    const double thick = k % 4 < 2 ? 0.0 : 0.05;
    const auto told = timeOfImpact(edges, x, thick);
    const Real nearest = minDistance(edges, x, 1.0L, 60);
    if (!told && nearest < 1e-6L + 1.01L * static_cast<Real>(thick)) continue;  // so near that roundings decide
    const auto same = [&](const CcdPoints& other, double min_distance, const char* what) {
      const auto again = timeOfImpact(edges, other, min_distance);
      ASSERT_EQ(told.has_value(), again.has_value()) << what << " " << k;
      ASSERT_NEAR(told.value_or(2.0), again.value_or(2.0), 1e-6) << what << " " << k;
    };
    same(edges ? CcdPoints{x[2], x[3], x[0], x[1], x[6], x[7], x[4], x[5]}
               : CcdPoints{x[0], x[2], x[3], x[1], x[4], x[6], x[7], x[5]},
         thick, "order");
    same(edges ? CcdPoints{x[1], x[0], x[2], x[3], x[5], x[4], x[6], x[7]}
               : CcdPoints{x[0], x[2], x[1], x[3], x[4], x[6], x[5], x[7]},
         thick, "orientation");
    CcdPoints moved = x;
    for (Vec3& point : moved) point += Vec3(1e3, -1e3, 1e3);
    same(moved, thick, "place");
    for (const double scale : {1e-3, 1e3}) {
      CcdPoints scaled = x;
      for (Vec3& point : scaled) point *= scale;
      same(scaled, scale * thick, "scale");
    }
    if (HasFatalFailure()) return;
  }
}

// Corners on a coarse grid of whole numbers: many fall together, in one line or in one plane, and many touch exactly.
TEST(CcdDegenerate, HoldsOnGridsOfWholeNumbers) {
  Random random(8);
  int hits = 0;
  for (int k = 0; k < 1200; ++k) {
    const bool edges = k % 2 == 1;
    const int flat = k / 2 % 4;  // 3: all in space, 2: in a plane, 1: on a line, 0: nothing moves
    CcdPoints x;
    for (Vec3& point : x) {
      for (int i = 0; i < 3; ++i) point[i] = i < std::max(flat, 1) ? std::floor(random.between(-3.0, 4.0)) : 0.0;
    }
    if (flat == 0) {
      for (std::size_t i = 0; i < 4; ++i) x[i + 4] = x[i] = Vec3(x[i].x(), x[i + 4].x(), x[i].x() * 2.0);
    }
    SCOPED_TRACE("query " + std::to_string(k));
    expectTrue(edges, x, 0.0, hits);
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(hits, 120);
}

TEST(CcdDegenerate, TouchingAtTheStartIsZero) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), up(0, 0, 1);
  for (const Vec3& p : {Vec3(0.25, 0.25, 0), a, b, Vec3(0.5, 0.5, 0), Vec3(0.5, 0, 0)}) {
    EXPECT_EQ(timeOfImpact(false, {p, a, b, c, p + up, a, b, c}), 0.0);
    EXPECT_EQ(timeOfImpact(false, {p + 0.01 * up, a, b, c, p + up, a, b, c}, 0.01), 0.0);
    EXPECT_EQ(timeOfImpact(false, {p, p, p, p, p + up, p, p, p}), 0.0);
  }
  EXPECT_EQ(timeOfImpact(true, {a, b, Vec3(0.5, -1, 0), c, a + up, b + up, Vec3(0.5, -1, 0), c}), 0.0);
  EXPECT_EQ(timeOfImpact(true, {a, b, Vec3(0.5, 0, 0), Vec3(2, 0, 0), a + up, b + up, Vec3(0.5, 0, 0), Vec3(2, 0, 0)}),
            0.0);
  EXPECT_EQ(timeOfImpact(true, {a, b, a + 0.1 * up, b + 0.1 * up, a, b, a + up, b + up}, 0.11), 0.0);
}

TEST(CcdDegenerate, WithoutMotionOnlyATouchIsAnImpact) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0), p(0.2, 0.2, 1e-9);
  EXPECT_FALSE(timeOfImpact(false, {p, a, b, c, p, a, b, c}).has_value());
  EXPECT_FALSE(timeOfImpact(true, {a, b, c + p, p, a, b, c + p, p}).has_value());
  EXPECT_TRUE(timeOfImpact(false, {p, a, b, c, p, a, b, c}, 1e-9).has_value());
  EXPECT_FALSE(timeOfImpact(false, {p, a, b, c, p, a, b, c}, 0.999e-9).has_value());
  EXPECT_FALSE(timeOfImpact(false, {p, a, b, c, p, a, b, c}, -1.0).has_value());
}

TEST(CcdDegenerate, LessThanZeroIsZero) {
  for (const CcdQuery& query : readCcdQueries("queries_cloth.bin")) {
    ASSERT_EQ(timeOfImpact(query.edges, query.points, -1.0), timeOfImpact(query.edges, query.points));
  }
}

// A millimetre's triangle passed at 50 m a step: the time must be that of the plane.
TEST(CcdDegenerate, FastMotionIsSeen) {
  Random random(9);
  for (int k = 0; k < 500; ++k) {
    const Vec3 normal = random.direction();
    const Vec3 along = normal.unitOrthogonal();
    const Vec3 across = normal.cross(along);
    const Vec3 a = 1e-3 * along, b = 1e-3 * (across - along), c = -1e-3 * (across + along);
    const double t = random.between(0.1, 0.9);
    const Vec3 start = -50.0 * t * normal;
    const Vec3 end = 50.0 * (1.0 - t) * normal;
    const auto told = timeOfImpact(false, {start, a, b, c, end, a, b, c});
    ASSERT_TRUE(told.has_value());
    ASSERT_LE(*told, t + 1e-15);
    ASSERT_NEAR(*told, t, 1e-14);
    const Vec3 aside = 1.1e-3 * across;
    ASSERT_FALSE(timeOfImpact(false, {start + aside, a, b, c, end + aside, a, b, c}).has_value());
    const auto edges = timeOfImpact(true, {start + a, start - a, across, -across, end + a, end - a, across, -across});
    ASSERT_TRUE(edges.has_value());
    ASSERT_LE(*edges, t + 1e-15);
    ASSERT_NEAR(*edges, t, 1e-14);
  }
}

TEST(CcdDegenerate, NotFiniteIsAnImpactAtOnce) {
  Random random(10);
  CcdPoints apart;
  for (std::size_t i = 0; i < 8; ++i) apart[i] = random.inBox(1.0) + Vec3(i % 4 == 0 ? 100.0 : 0.0, 0.0, 0.0);
  ASSERT_FALSE(timeOfImpact(false, apart).has_value());
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), infinity, -infinity, 1e300}) {
    for (const bool edges : {false, true}) {
      for (std::size_t i = 0; i < 8; ++i) {
        for (int k = 0; k < 3; ++k) {
          CcdPoints x = apart;
          x[i][k] = bad;
          EXPECT_EQ(timeOfImpact(edges, x), 0.0) << bad << " " << i << " " << k;
        }
      }
    }
  }
  EXPECT_EQ(timeOfImpact(false, apart, std::nan("")), 0.0);
  EXPECT_EQ(timeOfImpact(false, apart, infinity), 0.0);
}

}  // namespace
