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

constexpr std::uint32_t kPoints = 8;  // of a pair of quads; an element pair has the first four
constexpr std::size_t kNodes = kPoints * kPairsAtOnce;

SweptNode swept(const Vec3& start, const Vec3& end) {
  const auto lanes = [](const Vec3& at) {
    const Eigen::Vector3f rounded = at.cast<float>();
    return Eigen::Array4f(rounded.x(), rounded.y(), rounded.z(), 0.0f);
  };
  return {lanes(start), lanes(end)};
}

// Bits of the element pairs that are proved to stay apart; the points of a pair come one after the other.
std::uint32_t separated(bool edges, const std::array<SweptNode, kNodes>& nodes, float reach, float rounding) {
  Clusters clusters{{}, 4};
  for (std::uint32_t n = 0; n < 4; ++n) {
    for (std::uint32_t k = 0; k < kPairsAtOnce; ++k) clusters.nodes[n][k] = kPoints * k + n;
  }
  const std::vector<LocalPair> none, one{{0, 1, 2, 3}};
  std::uint8_t near = 0;
  findNear(clusters, {nodes.data(), reach, rounding}, edges ? none : one, edges ? one : none, &near);
  return ~static_cast<std::uint32_t>(near) & 0xFFU;
}

// Least distance of a pair at 33 instants; points(n) is its n-th point's place.
template <typename Distance>
double minDistance(const std::array<SweptNode, kNodes>& nodes, std::size_t pair, const Distance& distance) {
  double least = 1e300;
  for (int instant = 0; instant <= 32; ++instant) {
    const double t = instant / 32.0;
    least = std::min(
        least, distance([&](std::size_t n) -> Vec3 {
          const SweptNode& node = nodes[kPoints * pair + n];
          return ((1.0 - t) * node.start.head<3>().cast<double>() + t * node.end.head<3>().cast<double>()).matrix();
        }));
  }
  return least;
}

// Pairs by chance and close to the reach: what is said to stay apart does, and what is far is said to.
TEST(SeparatingAxis, IsProvedOfWhatStaysApartAlone) {
  Random random(5);
  int proved = 0, apart_in_truth = 0;
  for (int round = 0; round < 4000; ++round) {
    std::array<SweptNode, kNodes> nodes;
    const double size = random.between(0.005, 0.05), speed = random.between(0.0, 0.03);
    const Vec3 common = random.inBox(0.1);
    for (SweptNode& node : nodes) {
      const Vec3 place = random.inBox(size);
      node = swept(place, place + common + random.inBox(speed));
    }
    const double reach = random.between(0.0, 0.01);
    for (const bool edges : {false, true}) {
      const std::uint32_t lanes = separated(edges, nodes, static_cast<float>(reach), 1e-7f);
      for (std::size_t k = 0; k < kPairsAtOnce; ++k) {
        const double least = minDistance(nodes, k, [&](const auto& at) {
          return edges ? distanceOfSegments(at(0), at(1), at(2), at(3))
                       : distanceToTriangle(at(0), at(1), at(2), at(3));
        });
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

// The distance of two quads is that of two of their edges, or of a corner and a triangle.
double distanceOfQuads(const std::array<Vec3, kPoints>& at) {
  constexpr std::size_t kTriangles[2][3] = {{0, 2, 1}, {1, 2, 3}},
                        kEdges[5][2] = {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}};
  double least = 1e300;
  for (const auto& [a, b, c] : kTriangles) {
    for (std::size_t n = 0; n < 4; ++n) {
      least = std::min({least, distanceToTriangle(at[n], at[a + 4], at[b + 4], at[c + 4]),
                        distanceToTriangle(at[n + 4], at[a], at[b], at[c])});
    }
  }
  for (const auto& [a, b] : kEdges) {
    for (const auto& [c, d] : kEdges) least = std::min(least, distanceOfSegments(at[a], at[b], at[c + 4], at[d + 4]));
  }
  return least;
}

// Two quads side by side in space, four of their corners in each row of nodes: bent, moved, and near each other.
TEST(SeparatingAxis, IsProvedOfQuadsThatStayApartAlone) {
  constexpr std::size_t kStride = 2 * kPairsAtOnce * 2;
  Random random(9);
  int proved = 0, apart_in_truth = 0;
  for (int round = 0; round < 1500; ++round) {
    std::array<SweptNode, kNodes> corners;
    const double speed = random.between(0.0, 0.02), reach = random.between(0.0, 0.008);
    for (std::size_t k = 0; k < kPairsAtOnce; ++k) {
      for (const std::size_t first : {0U, 4U}) {
        const Vec3 middle = random.inBox(0.03), along = random.inBox(0.03), down = random.inBox(0.03);
        const Vec3 move = random.inBox(speed);
        for (std::size_t n = 0; n < 4; ++n) {
          const Vec3 place =
              middle + (n % 2 == 0 ? -0.5 : 0.5) * along + (n < 2 ? -0.5 : 0.5) * down + random.inBox(0.004);
          corners[kPoints * k + first + n] = swept(place, place + move + random.inBox(0.003));
        }
      }
    }
    std::vector<SweptNode> rows(2 * kStride);
    std::array<TwoQuads, kPairsAtOnce> pairs;
    for (std::uint32_t k = 0; k < kPairsAtOnce; ++k) {
      pairs[k] = {4 * k, 4 * k + 2};
      for (std::size_t n = 0; n < kPoints; ++n)
        rows[4 * k + n / 4 * 2 + n % 2 + n % 4 / 2 * kStride] = corners[kPoints * k + n];
    }
    std::uint32_t before = 0;
    for (const int steps : {0, 1, 4}) {
      const std::uint32_t lanes =
          quadsSeparated(pairs, {rows.data(), static_cast<float>(reach), 1e-7f}, kStride, steps);
      EXPECT_EQ(lanes & before, before) << "more steps prove more";
      before = lanes;
    }
    for (std::size_t k = 0; k < kPairsAtOnce; ++k) {
      const double least = minDistance(corners, k, [&](const auto& at) {
        return distanceOfQuads({at(0), at(1), at(2), at(3), at(4), at(5), at(6), at(7)});
      });
      const bool said = (before >> k & 1U) != 0;
      if (said) {
        EXPECT_GT(least, reach) << round;
      }
      proved += said ? 1 : 0;
      apart_in_truth += least > reach ? 1 : 0;
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
    const double trifle = round % 4 == 0 ? 0.0 : round % 4 == 1 ? 1e-7 : 0.01;
    for (std::uint32_t n = 0; n < kNodes; ++n) {
      const Vec3 way = random.inBox(0.02);
      start[n] = n % 4 < 2 ? random.inBox(0.05) : Vec3(start[n - 2] + Vec3(0.0, 0.0, 0.01) + random.inBox(trifle));
      if (round % 5 == 0 && n % 4 == 1) start[n] = start[n - 1];
      end[n] = n % 4 == 0 ? Vec3(start[n] + way) : Vec3(start[n] + end[n - 1] - start[n - 1]);
    }
    const auto provedIn = [&](double unit, bool edges) {
      std::array<SweptNode, kNodes> nodes;
      for (std::size_t n = 0; n < kNodes; ++n) nodes[n] = swept(unit * start[n], unit * end[n]);
      return separated(edges, nodes, static_cast<float>(unit * 0.005), static_cast<float>(unit * 1e-7));
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
