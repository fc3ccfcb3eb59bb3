// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of quads without a common node whose boxes come near each other. Of every level all pairs of blocks are asked
// that do not touch while their parents do, so that every pair of quads is in just one pair of their ancestors. Such
// pairs are at few offsets from each other: at each, those of a whole level lie side by side in memory. A pair whose
// boxes come near is followed down to its quads.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "contact/broad_phase/block_pyramid.h"

namespace curtain {

/// Thread-safe while the pyramid stays as it is.
class BlockPairs {
 public:
  /// One of equal shares of the rows of every level: number `index` of `count`.
  struct Share {
    int index = 0, count = 1;
    int firstOf(int rows) const noexcept { return rows * index / count; }
    int endOf(int rows) const noexcept { return rows * (index + 1) / count; }
  };

  /// pyramid must outlive this.
  explicit BlockPairs(const BlockPyramid& pyramid);

  /// Whether there are any, asked for or not, in blocks of a level or above that do not touch.
  bool any(float reach, std::size_t from_level) const noexcept;
  /// Calls take(a, b) for all quads, by their places in the pyramid, that are asked for, have boxes no further apart
  /// than `reach` [m] along every axis, and are in blocks of a level or above that do not touch, the first of them in
  /// the share. Allocates nothing.
  template <typename Take>
  void find(float reach, std::size_t from_level, const Share& share, const Take& take) const noexcept {
    for (const Ring& ring : rings_) {
      if (ring.level < from_level) continue;
      findAt(ring, reach, share, [&](std::size_t a, std::size_t b) {
        if (pyramid_.isAsked(a, b)) follow(ring.level, a, b, reach, take);
      });
    }
  }

 private:
  struct Offset {
    int down, right;
  };
  /// Of a row, of eight columns each; rows have 4096 at most.
  using NearBits = std::array<std::uint8_t, 512>;
  /// All pairs at one offset of one level.
  struct Ring {
    std::size_t level;
    Offset offset;
    std::array<std::vector<std::uint8_t>, 2> needed;  // by even and odd rows: bits of eight columns each
  };

  void makeRings();
  int columnBeyond(const BlockPyramid::Level& level, int j, const Offset& offset) const noexcept;
  int across(const BlockPyramid::Level& level, int j, int k) const noexcept;
  bool isNeeded(std::size_t level, const Offset& offset, int i, int j) const noexcept;
  bool findNear(const Ring& ring, int row, float reach, NearBits& near) const noexcept;
  // Calls take(a, b) for the blocks that are near.
  template <typename Take>
  void findAt(const Ring& ring, float reach, const Share& share, const Take& take) const noexcept {
    const BlockPyramid::Level& level = pyramid_.levels()[ring.level];
    NearBits near;
    for (int i = share.firstOf(level.rows); i < std::min(share.endOf(level.rows), level.rows - ring.offset.down); ++i) {
      if (!findNear(ring, i, reach, near)) continue;
      const std::size_t groups = ring.needed[static_cast<std::size_t>(i % 2)].size();
      for (std::size_t group = 0; group < groups; ++group) {
        for (std::uint32_t bits = near[group]; bits != 0; bits &= bits - 1) {
          const int j = static_cast<int>(8 * group) + __builtin_ctz(bits);
          take(level.at(i, j), level.at(i + ring.offset.down, columnBeyond(level, j, ring.offset)));
        }
      }
    }
  }
  std::size_t childrenNear(std::size_t level, std::size_t block, std::size_t other, float reach,
                           std::array<std::size_t, 4>& children) const noexcept;
  // Down to quads whose boxes come near.
  template <typename Take>
  void follow(std::size_t level, std::size_t a, std::size_t b, float reach, const Take& take) const noexcept {
    if (!pyramid_.isMarked(a, b)) return;
    if (level == 0) {
      take(a, b);
      return;
    }
    std::array<std::size_t, 4> of_a, of_b;
    const std::size_t count_a = childrenNear(level, a, b, reach, of_a),
                      count_b = count_a == 0 ? 0 : childrenNear(level, b, a, reach, of_b);
    for (std::size_t k = 0; k < count_a; ++k) {
      for (std::size_t l = 0; l < count_b; ++l) {
        if (pyramid_.meet(of_a[k], of_b[l], reach)) follow(level - 1, of_a[k], of_b[l], reach, take);
      }
    }
  }

  const BlockPyramid& pyramid_;
  std::vector<Ring> rings_;
};

}  // namespace curtain
