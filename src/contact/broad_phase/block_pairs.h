// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of quads without a common node whose boxes come near each other. Of every level all pairs of blocks are asked that do not touch
// while their parents do, so that every pair of quads is in just one pair of their ancestors. Such pairs are at few offsets from each
// other: at each, those of a whole level lie side by side in memory. A pair whose boxes come near is followed down to its quads.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "contact/broad_phase/block_pyramid.h"

namespace curtain {

/// Not thread-safe.
class BlockPairs {
 public:
  /// Two quads, by their places in the pyramid.
  struct Pair {
    std::uint32_t a, b;
  };

  /// pyramid must outlive this.
  explicit BlockPairs(const BlockPyramid& pyramid);

  /// Finds all with a quad that is wanted and boxes no further apart than `reach` [m] along every axis. Allocates nothing; false: no
  /// room for all.
  bool find(float reach) noexcept;
  const std::vector<Pair>& found() const noexcept { return found_; }

 private:
  struct Offset {
    int down, right;
  };
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
  void findAt(const Ring& ring) noexcept;
  void follow(std::size_t level, std::size_t a, std::size_t b) noexcept;

  const BlockPyramid& pyramid_;
  std::vector<Ring> rings_;
  std::vector<std::uint8_t> near_;  // of a row, as needed
  std::vector<Pair> found_;
  float reach_ = 0.0f;
  bool full_ = false;
};

}  // namespace curtain
