// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/block_pairs.h"

#include <algorithm>
#include <cstdlib>

#include "contact/narrow_phase/lanes8.h"

namespace curtain {
namespace {

struct Boxes {
  const float *low[3], *high[3];
};

// Pairs of boxes side by side that are no further apart than the reach along every axis, as bits of eight each, of
// those that are needed; returns whether there are any.
CURTAIN_WIDE bool nearPairs(const Boxes& p, const Boxes& q, const std::vector<std::uint8_t>& needed, float reach,
                            std::uint8_t* near) {
  std::uint32_t any = 0;
  for (std::size_t group = 0; group < needed.size(); ++group) {
    Eight::Lanes widest = Eight::Lanes{} - 1.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      Eight::Lanes low_p, high_p, low_q, high_q;
      Eight::load(p.low[k] + 8 * group, low_p);
      Eight::load(p.high[k] + 8 * group, high_p);
      Eight::load(q.low[k] + 8 * group, low_q);
      Eight::load(q.high[k] + 8 * group, high_q);
      const Eight::Lanes beyond = low_p - high_q, before = low_q - high_p;
      widest = beyond > widest ? beyond : widest;
      widest = before > widest ? before : widest;
    }
    near[group] = static_cast<std::uint8_t>(Eight::bitsOf(widest <= reach) & needed[group]);
    any |= near[group];
  }
  return any != 0;
}

}  // namespace

BlockPairs::BlockPairs(const BlockPyramid& pyramid) : pyramid_(pyramid) { makeRings(); }

void BlockPairs::makeRings() {
  for (std::size_t level = 0; level < pyramid_.levels().size(); ++level) {
    const BlockPyramid::Level& blocks = pyramid_.levels()[level];
    const auto groups = static_cast<std::size_t>(blocks.columns + 7) / 8;
    for (int down = 0; down <= std::min(BlockPyramid::kReach, blocks.rows - 1); ++down) {
      for (int right = down == 0 ? 2 : -BlockPyramid::kReach; right <= BlockPyramid::kReach; ++right) {
        if (std::max(down, std::abs(right)) < 2) continue;
        Ring ring{level, {down, right}, {}};
        for (std::size_t odd = 0; odd < 2; ++odd) {
          ring.needed[odd].assign(groups, 0);
          for (int j = 0; j < blocks.columns; ++j) {
            if (!isNeeded(level, ring.offset, static_cast<int>(odd), j)) continue;
            auto& bits = ring.needed[odd][static_cast<std::size_t>(j) / 8];
            bits = static_cast<std::uint8_t>(bits | 1U << (j % 8));
          }
          if (std::all_of(ring.needed[odd].begin(), ring.needed[odd].end(),
                          [](std::uint8_t bits) { return bits == 0; }))
            ring.needed[odd].clear();
        }
        if (!ring.needed[0].empty() || !ring.needed[1].empty()) rings_.push_back(std::move(ring));
      }
    }
  }
}

int BlockPairs::columnBeyond(const BlockPyramid::Level& level, int j, const Offset& offset) const noexcept {
  const int k = j + offset.right;
  return pyramid_.closed() ? (k + level.columns) % level.columns : k;
}

// Columns from one to the other, the shorter way around.
int BlockPairs::across(const BlockPyramid::Level& level, int j, int k) const noexcept {
  const int apart = std::abs(k - j);
  return pyramid_.closed() ? std::min(apart, level.columns - apart) : apart;
}

// Depends on i only by whether it is odd.
bool BlockPairs::isNeeded(std::size_t at_level, const Offset& offset, int i, int j) const noexcept {
  const BlockPyramid::Level& level = pyramid_.levels()[at_level];
  if (pyramid_.closed()) {
    // A pair that is at two offsets is taken at one of them.
    if (2 * std::abs(offset.right) > level.columns) return false;
    if (2 * std::abs(offset.right) == level.columns &&
        (offset.down == 0 ? j + offset.right >= level.columns : offset.right < 0))
      return false;
  } else if (j + offset.right < 0 || j + offset.right >= level.columns) {
    return false;
  }
  if (at_level + 1 == pyramid_.levels().size()) return true;
  const int rows = (i + offset.down) / 2 - i / 2;
  return std::max(rows, across(pyramid_.levels()[at_level + 1], j / 2, columnBeyond(level, j, offset) / 2)) < 2;
}

// Whether there are any in a row; near tells which.
bool BlockPairs::findNear(const Ring& ring, int row, float reach, NearBits& near) const noexcept {
  const BlockPyramid::Level& level = pyramid_.levels()[ring.level];
  const std::vector<std::uint8_t>& needed = ring.needed[static_cast<std::size_t>(row % 2)];
  if (needed.empty() || !pyramid_.areRowsAsked(ring.level, row, row + ring.offset.down)) return false;
  const auto boxes = [this](std::size_t first) {
    const auto &low = pyramid_.lows(), &high = pyramid_.highs();
    return Boxes{{&low[0][first], &low[1][first], &low[2][first]}, {&high[0][first], &high[1][first], &high[2][first]}};
  };
  return nearPairs(boxes(level.at(row, 0)), boxes(level.at(row + ring.offset.down, ring.offset.right)), needed, reach,
                   near.data());
}

// Those of a block's children that come near another block; returns how many.
std::size_t BlockPairs::childrenNear(std::size_t at_level, std::size_t block, std::size_t other, float reach,
                                     std::array<std::size_t, 4>& children) const noexcept {
  const BlockPyramid::Level &level = pyramid_.levels()[at_level], &below = pyramid_.levels()[at_level - 1];
  const int i = level.rowOf(block), j = level.columnOf(block);
  std::size_t count = 0;
  for (int row = 2 * i; row < std::min(2 * i + 2, below.rows); ++row) {
    for (int column = 2 * j; column < std::min(2 * j + 2, below.columns); ++column) {
      const std::size_t child = below.at(row, column);
      if (pyramid_.meet(child, other, reach)) children[count++] = child;
    }
  }
  return count;
}

bool BlockPairs::any(float reach, std::size_t from_level) const noexcept {
  bool found = false;
  for (const Ring& ring : rings_) {
    if (ring.level >= from_level) findAt(ring, reach, Share(), [&](std::size_t, std::size_t) { found = true; });
  }
  return found;
}

}  // namespace curtain
