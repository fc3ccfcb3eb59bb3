// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of quads without a common node whose boxes come near each other.
//
// Two blocks of a level are neighbours when they touch. Tested on each level are the blocks that are not neighbours
// while their parents are, as in the interaction lists of a fast multipole method: every pair of quads has exactly one
// such pair of ancestors. Seen as offsets (rows down, columns right) there are few of them, and at one offset the boxes
// of a whole row lie side by side in memory. Overlapping pairs of blocks are descended to their quads.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "contact/broad_phase/box_hierarchy.h"

namespace curtain {

/// Thread-safe while the hierarchy does not change.
class HierarchyPairs {
 public:
  /// Share number `index` of `count` equal shares of the rows of every level.
  struct Share {
    int index = 0, count = 1;
    int firstOf(int rows) const noexcept { return rows * index / count; }
    int endOf(int rows) const noexcept { return rows * (index + 1) / count; }
  };

  /// hierarchy must outlive this.
  explicit HierarchyPairs(const BoxHierarchy& hierarchy);

  /// Whether any pair of non-neighbouring blocks of `from_level` or above is within `reach` [m], wanted or not.
  bool any(float reach, std::size_t from_level) const noexcept;
  /// Calls take(a, b) (indices in the hierarchy) for all wanted pairs of quads whose boxes are at most `reach` [m]
  /// apart along every axis. Pairs of level `from_level` and above only, the first block in the share. Allocates
  /// nothing.
  template <typename Take>
  void find(float reach, std::size_t from_level, const Share& share, const Take& take) const noexcept {
    for (const LevelOffset& entry : level_offsets_) {
      if (entry.level < from_level) continue;
      findAt(entry, reach, share, [&](std::size_t a, std::size_t b) {
        if (hierarchy_.isWanted(a, b)) descend(entry.level, a, b, reach, take);
      });
    }
  }

 private:
  struct Offset {
    int down, right;
  };
  /// Bits of a row of blocks, eight columns a byte; a row has at most 4096.
  using NearBits = std::array<std::uint8_t, 512>;
  /// All pairs of blocks at one offset of one level.
  struct LevelOffset {
    std::size_t level;
    Offset offset;
    std::array<std::vector<std::uint8_t>, 2> needed;  // by parity of the row: bit of each first block, eight a byte
  };

  void makeLevelOffsets();
  int offsetColumn(const BoxHierarchy::Level& level, int j, const Offset& offset) const noexcept;
  int columnDistance(const BoxHierarchy::Level& level, int j, int k) const noexcept;
  bool isNeeded(std::size_t level, const Offset& offset, int i, int j) const noexcept;
  bool findNear(const LevelOffset& entry, int row, float reach, NearBits& near) const noexcept;
  // Calls take(a, b) for the blocks within reach.
  template <typename Take>
  void findAt(const LevelOffset& entry, float reach, const Share& share, const Take& take) const noexcept {
    const BoxHierarchy::Level& level = hierarchy_.levels()[entry.level];
    NearBits near;
    for (int i = share.firstOf(level.rows); i < std::min(share.endOf(level.rows), level.rows - entry.offset.down);
         ++i) {
      if (!findNear(entry, i, reach, near)) continue;
      const std::size_t groups = entry.needed[static_cast<std::size_t>(i % 2)].size();
      for (std::size_t group = 0; group < groups; ++group) {
        for (std::uint32_t bits = near[group]; bits != 0; bits &= bits - 1) {
          const int j = static_cast<int>(8 * group) + __builtin_ctz(bits);
          take(level.at(i, j), level.at(i + entry.offset.down, offsetColumn(level, j, entry.offset)));
        }
      }
    }
  }
  std::size_t childrenNear(std::size_t level, std::size_t block, std::size_t other, float reach,
                           std::array<std::size_t, 4>& children) const noexcept;
  // Descends to the quads whose boxes are within reach.
  template <typename Take>
  void descend(std::size_t level, std::size_t a, std::size_t b, float reach, const Take& take) const noexcept {
    if (!hierarchy_.isMarked(a, b)) return;
    if (level == 0) {
      take(a, b);
      return;
    }
    std::array<std::size_t, 4> of_a, of_b;
    const std::size_t count_a = childrenNear(level, a, b, reach, of_a),
                      count_b = count_a == 0 ? 0 : childrenNear(level, b, a, reach, of_b);
    for (std::size_t k = 0; k < count_a; ++k) {
      for (std::size_t l = 0; l < count_b; ++l) {
        if (hierarchy_.meet(of_a[k], of_b[l], reach)) descend(level - 1, of_a[k], of_b[l], reach, take);
      }
    }
  }

  const BoxHierarchy& hierarchy_;
  std::vector<LevelOffset> level_offsets_;
};

}  // namespace curtain
