// SPDX-License-Identifier: BSD-3-Clause
//
// Patches against all pairs of quads: each two quads without a common node whose boxes meet are named once, by any
// number of workers.
#include "contact/broad_phase/patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "testing.h"

namespace curtain {
namespace {

using curtain_test::flatScene;
using curtain_test::Random;

constexpr float kReach = 0.01f;

struct Scattered {
  Field3 start, end;
};

// Nodes at places `link` [m] apart, scattered and moved; 0: all in one point.
Scattered scatter(const Grid& grid, double link, Random& random) {
  Scattered nodes;
  for (Field3* const at : {&nodes.start, &nodes.end}) at->assign(grid.size(), 0.0);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const Vec3 place = Vec3(link * j, 0.0, link * i) + random.inBox(2.0 * link);
      nodes.start.set(grid.index(i, j), place);
      nodes.end.set(grid.index(i, j), place + random.inBox(0.5 * link));
    }
  }
  return nodes;
}

// How often each two quads are named; quads are numbered row by row.
std::map<std::pair<int, int>, int> named(const SweptNodes& nodes, std::size_t shares) {
  const Grid& grid = nodes.grid();
  Scene scene = flatScene(grid.rows, grid.columns, 1.0);
  scene.cloth.closed = grid.closed;
  const Spacings per_spacing(makePattern(scene));
  FlatPatches boxes(grid, per_spacing);
  Patches patches(grid, Gaps(grid, 2));
  for (int row = 0; row < patches.rows(); ++row) {
    boxes.measureRow(nodes, row);
    patches.fitRow(nodes, row);
  }
  patches.sort(boxes);
  const auto number = [&](std::uint32_t quad) {
    return static_cast<int>(quad) / grid.stride * grid.linkCount() + static_cast<int>(quad) % grid.stride;
  };
  std::map<std::pair<int, int>, int> found;
  for (std::size_t share = 0; share < shares; ++share) {
    patches.forEachPair(kReach, share, shares, [&](int a, int b) {
      patches.forEachQuadPair(a, b, kReach, [&](std::uint32_t p, std::uint32_t q) {
        ++found[std::minmax({number(p), number(q)})];
      });
    });
  }
  return found;
}

Eigen::AlignedBox3d boxOf(const Grid& grid, const Scattered& nodes, int quad) {
  const int i = quad / grid.linkCount(), j = quad % grid.linkCount();
  Eigen::AlignedBox3d box;
  for (const int row : {i, i + 1}) {
    for (const int column : {j, (j + 1) % grid.columns}) {
      const std::size_t n = grid.index(row, column);
      box.extend(nodes.start.at(n)).extend(nodes.end.at(n));
    }
  }
  return box;
}

// Takes the mean motion, over every fourth row, out of the end: boxes are those of what is left of the motion.
void holdStill(const Grid& grid, Scattered& nodes) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (int i = 0; i < grid.rows; i += 4) {
    for (int j = 0; j < grid.columns; ++j, ++count)
      sum += nodes.end.at(grid.index(i, j)) - nodes.start.at(grid.index(i, j));
  }
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      nodes.end.set(n, nodes.end.at(n) - sum / count);
    }
  }
}

class PatchesOfGrids : public testing::TestWithParam<bool> {};

TEST_P(PatchesOfGrids, NameEachTwoQuadsThatMeetOnce) {
  Random random(3);
  std::size_t met = 0, apart = 0;
  for (int rows = 2; rows < 15; ++rows) {
    for (int columns = GetParam() ? 5 : 2; columns < 15; ++columns) {
      const Grid grid(rows, columns, GetParam());
      for (const double link : {0.0, 0.01}) {
        Scattered places = scatter(grid, link, random);
        holdStill(grid, places);
        SweptNodes nodes(grid);
        nodes.set(places.start, places.end);
        const std::map<std::pair<int, int>, int> found = named(nodes, 1);
        EXPECT_EQ(named(nodes, 3), found);
        const int wide = grid.linkCount(), count = (rows - 1) * wide;
        std::size_t expected = 0;
        for (int a = 0; a < count; ++a) {
          for (int b = a + 1; b < count; ++b) {
            int across = std::abs(a % wide - b % wide);
            if (GetParam()) across = std::min(across, wide - across);
            const Eigen::AlignedBox3d one = boxOf(grid, places, a), other = boxOf(grid, places, b);
            const double gap = (one.min() - other.max()).cwiseMax(other.min() - one.max()).maxCoeff();
            const auto pair = found.find({a, b});
            const int times = pair == found.end() ? 0 : pair->second;
            const bool shared = std::max(std::abs(a / wide - b / wide), across) < 2;
            expected += times > 0 ? 1 : 0;
            (gap > kReach ? apart : met) += shared ? 0 : 1;
            if (std::abs(gap - kReach) < 1e-6) continue;
            ASSERT_EQ(times, shared || gap > kReach ? 0 : 1)
                << rows << " x " << columns << ": " << a << ", " << b << ", " << gap;
          }
        }
        EXPECT_EQ(found.size(), expected) << rows << " x " << columns << ": quads that are not in the grid";
      }
    }
  }
  EXPECT_GT(met, 10000u);
  EXPECT_GT(apart, 10000u);
}

INSTANTIATE_TEST_SUITE_P(OpenAndClosed, PatchesOfGrids, testing::Bool());

// Whatever is said to end where it was expected, seen from each other, does.
TEST(Patches, SayWhatDeviates) {
  Random random(8);
  int still = 0;
  for (int round = 0; round < 200; ++round) {
    const Grid grid(3 + round % 11, 5 + round % 7, round % 2 == 1);
    Scattered places = scatter(grid, 1.0, random);
    SweptNodes nodes(grid);
    nodes.set(places.start, places.end);
    nodes.setLargest(20.0f);
    std::vector<Vec3> deviation(grid.size(), Vec3::Zero());
    const Vec3 common = random.inBox(0.3);
    for (std::size_t n = 0; n < grid.size(); ++n) {
      deviation[n] = common + random.inBox(random.between(0.0, 1.0) < 0.1 ? 0.02 : 0.001);
      places.end.set(n, places.end.at(n) + deviation[n]);
    }
    nodes.setEnd(places.start);  // what is told in between does not matter
    nodes.setEnd(places.end);
    Patches patches(nodes.grid(), Gaps(nodes.grid(), 2));
    const float spread = patches.measureDeviations(nodes);
    const float most = 0.015f;
    // With the quads next to a patch on the right and below.
    const auto nodesOf = [&](int patch) {
      std::vector<std::size_t> of;
      const int row = patch / patches.columns() * Patches::kAlong, column = patch % patches.columns() * Patches::kAlong;
      for (int i = row; i <= std::min(row + Patches::kAlong + 1, grid.rows - 1); ++i) {
        for (int j = column; j <= column + Patches::kAlong + 1; ++j) {
          if (grid.closed && j <= grid.columns + 1) of.push_back(grid.index(i, j % grid.columns));
          if (!grid.closed && j < grid.columns) of.push_back(grid.index(i, j));
        }
      }
      return of;
    };
    for (int a = 0; a < patches.rows() * patches.columns(); ++a) {
      for (int b = a; b < patches.rows() * patches.columns(); ++b) {
        double furthest = 0.0;
        for (const std::size_t n : nodesOf(a)) {
          for (const std::size_t m : nodesOf(b)) furthest = std::max(furthest, (deviation[n] - deviation[m]).norm());
        }
        EXPECT_LE(furthest, spread);
        if (patches.deviate(a, b, most)) continue;
        ++still;
        ASSERT_LE(furthest, most) << round << ": " << a << ", " << b;
      }
    }
  }
  EXPECT_GT(still, 300);
}

}  // namespace
}  // namespace curtain
