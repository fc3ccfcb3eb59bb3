// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of blocks against all pairs of quads: where every box meets every other one, each two quads without a common
// node are named once.
#include "contact/broad_phase/hierarchy_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>

namespace curtain {
namespace {

// How often each two quads are named; quads are numbered row by row.
std::map<std::pair<int, int>, int> named(BoxHierarchy& hierarchy, const Grid& grid) {
  MovingNodes nodes;
  nodes.stride = static_cast<std::size_t>(grid.closed ? Grid::strideFor(grid.columns + 2) : grid.stride);
  for (auto* const at : {&nodes.start, &nodes.end}) {
    for (auto& axis : *at) axis.assign(static_cast<std::size_t>(grid.rows) * nodes.stride + 16, 0.0f);
  }
  const auto origin = [](int, int, int) { return 0.0f; };
  const std::size_t level = std::min<std::size_t>(3, hierarchy.levels().size() - 1);
  hierarchy.refitFrom(level, origin, origin);
  hierarchy.select(nullptr);
  hierarchy.refitBelow(level, nodes);
  const BoxHierarchy::Level& quads = hierarchy.levels()[0];
  const auto number = [&](std::size_t quad) { return quads.rowOf(quad) * quads.columns + quads.columnOf(quad); };
  std::map<std::pair<int, int>, int> found;
  hierarchy.interleaveBoxes();
  HierarchyPairs(hierarchy).find(1.0f, 0, {}, [&](std::size_t a, std::size_t b) {
    ++found[std::minmax({number(a), number(b)})];
  });
  return found;
}

class HierarchyPairsOfGrids : public testing::TestWithParam<bool> {};

TEST_P(HierarchyPairsOfGrids, NameEachTwoQuadsWithoutACommonNodeOnce) {
  for (int rows = 2; rows < 19; ++rows) {
    for (int columns = GetParam() ? 5 : 2; columns < 19; ++columns) {
      const Grid grid(rows, columns, GetParam());
      BoxHierarchy hierarchy(grid);
      const std::map<std::pair<int, int>, int> found = named(hierarchy, grid);
      const int wide = grid.linkCount(), count = (rows - 1) * wide;
      std::size_t expected = 0;
      for (int a = 0; a < count; ++a) {
        for (int b = a + 1; b < count; ++b) {
          int across = std::abs(a % wide - b % wide);
          if (GetParam()) across = std::min(across, wide - across);
          if (std::max(std::abs(a / wide - b / wide), across) < 2) continue;
          ++expected;
          const auto pair = found.find({a, b});
          ASSERT_TRUE(pair != found.end() && pair->second == 1) << rows << " x " << columns << ": " << a << ", " << b;
        }
      }
      EXPECT_EQ(found.size(), expected) << rows << " x " << columns;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(OpenAndClosed, HierarchyPairsOfGrids, testing::Bool());

}  // namespace
}  // namespace curtain
