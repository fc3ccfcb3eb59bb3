// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs that an axis proves to stay apart do, and most of those that do are proved to, in any unit.
#include "contact/narrow_phase/separating_axis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "contact/element_distances.h"
#include "testing.h"

namespace curtain {
namespace {

using curtain_test::distanceOfSegments;
using curtain_test::distanceToTriangle;
using curtain_test::Random;

constexpr std::size_t kNodes = 4 * kPairsAtOnce;

// Simd8 pairs at a time, by chance and close to the reach: what is said to stay apart does, and what is far is said to.
TEST(SeparatingAxis, IsProvedOfWhatStaysApartAlone) {
  Random random(5);
  int proved = 0, apart_in_truth = 0;
  for (int round = 0; round < 4000; ++round) {
    std::array<Eigen::Array4f, kNodes> starts, ends;
    std::array<FourNodes, kPairsAtOnce> pairs;
    const double size = random.between(0.005, 0.05), speed = random.between(0.0, 0.03);
    const Vec3 common = random.inBox(0.1);
    for (std::uint32_t n = 0; n < kNodes; ++n) {
      const Vec3 place = random.inBox(size), move = common + random.inBox(speed);
      const Eigen::Vector3f start = place.cast<float>(), end = Vec3(place + move).cast<float>();
      starts[n] = {start.x(), start.y(), start.z(), 0.0f};
      ends[n] = {end.x(), end.y(), end.z(), 0.0f};
      pairs[n / 4][n % 4] = n;
    }
    const double reach = random.between(0.0, 0.01);
    for (const bool edges : {false, true}) {
      const auto lanes = (edges ? edgesSeparated : vertexSeparated)(pairs, {starts.data(), ends.data()},
                                                                    static_cast<float>(reach), 1e-7f);
      for (std::size_t k = 0; k < kPairsAtOnce; ++k) {
        double least = 1e300;
        for (int instant = 0; instant <= 32; ++instant) {
          const double t = instant / 32.0;
          const auto at = [&](std::size_t n) -> Vec3 {
            const std::uint32_t node = pairs[k][n];
            return ((1.0 - t) * starts[node].head<3>().cast<double>() + t * ends[node].head<3>().cast<double>())
                .matrix();
          };
          least = std::min(least, edges ? distanceOfSegments(at(0), at(1), at(2), at(3))
                                        : distanceToTriangle(at(0), at(1), at(2), at(3)));
        }
        const bool said = (lanes >> k & 1U) != 0;
        if (said) {
          EXPECT_GT(least, reach) << round << (edges ? " edges" : " vertex");
        }
        proved += said ? 1 : 0;
        apart_in_truth += least > reach ? 1 : 0;
      }
    }
  }
  EXPECT_GT(proved, apart_in_truth * 6 / 10);
}

// The same pairs in a doll's and in an airship's metres, many of edges that are nearly parallel, or none.
TEST(SeparatingAxis, IsProvedInAnyUnit) {
  Random random(6);
  int proved = 0;
  for (int round = 0; round < 4000; ++round) {
    std::array<Vec3, kNodes> start, end;
    std::array<FourNodes, kPairsAtOnce> pairs;
    const double trifle = round % 4 == 0 ? 0.0 : round % 4 == 1 ? 1e-7 : 0.01;
    for (std::uint32_t n = 0; n < kNodes; ++n) {
      const Vec3 way = random.inBox(0.02);
      start[n] = n % 4 < 2 ? random.inBox(0.05) : Vec3(start[n - 2] + Vec3(0.0, 0.0, 0.01) + random.inBox(trifle));
      if (round % 5 == 0 && n % 4 == 1) start[n] = start[n - 1];
      end[n] = n % 4 == 0 ? Vec3(start[n] + way) : Vec3(start[n] + end[n - 1] - start[n - 1]);
      pairs[n / 4][n % 4] = n;
    }
    const auto provedIn = [&](double unit, bool edges) {
      std::array<Eigen::Array4f, kNodes> starts, ends;
      for (std::size_t n = 0; n < kNodes; ++n) {
        const Eigen::Vector3f a = (unit * start[n]).cast<float>(), b = (unit * end[n]).cast<float>();
        starts[n] = {a.x(), a.y(), a.z(), 0.0f};
        ends[n] = {b.x(), b.y(), b.z(), 0.0f};
      }
      const auto reach = static_cast<float>(unit * 0.005), rounding = static_cast<float>(unit * 1e-7);
      return (edges ? edgesSeparated : vertexSeparated)(pairs, {starts.data(), ends.data()}, reach, rounding);
    };
    for (const bool edges : {false, true}) {
      const std::uint32_t bits = provedIn(1.0, edges);
      EXPECT_EQ(provedIn(0x1p-12, edges), bits) << round << (edges ? " edges" : " vertex");
      EXPECT_EQ(provedIn(0x1p12, edges), bits) << round << (edges ? " edges" : " vertex");
      proved += bits != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(proved, 1000);
}

}  // namespace
}  // namespace curtain
