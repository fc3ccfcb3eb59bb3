// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/block_pairs.h"

#include <algorithm>
#include <cstdlib>

#include "contact/narrow_phase/lanes8.h"

namespace curtain {
namespace {

// Pairs that there is room for, per quad.
constexpr std::size_t kRoom = 64;

struct Boxes {
  const float *low[3], *high[3];
};

// Pairs of boxes side by side that are no further apart than the reach along every axis, as bits of eight each, of those that are needed;
// returns whether there are any.
CURTAIN_WIDE bool nearPairs(const Boxes& p, const Boxes& q, const std::vector<std::uint8_t>& needed, float reach, std::uint8_t* near) {
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

BlockPairs::BlockPairs(const BlockPyramid& pyramid) : pyramid_(pyramid) {
  const BlockPyramid::Level& quads = pyramid.levels().front();
  makeRings();
  near_.assign(quads.stride, 0);
  found_.reserve(kRoom * static_cast<std::size_t>(quads.rows) * static_cast<std::size_t>(quads.columns));
}

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
          if (std::all_of(ring.needed[odd].begin(), ring.needed[odd].end(), [](std::uint8_t bits) { return bits == 0; })) ring.needed[odd].clear();
        }
        rings_.push_back(std::move(ring));
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
    if (2 * std::abs(offset.right) == level.columns && (offset.down == 0 ? j + offset.right >= level.columns : offset.right < 0)) return false;
  } else if (j + offset.right < 0 || j + offset.right >= level.columns) {
    return false;
  }
  if (at_level + 1 == pyramid_.levels().size()) return true;
  const int rows = (i + offset.down) / 2 - i / 2;
  return std::max(rows, across(pyramid_.levels()[at_level + 1], j / 2, columnBeyond(level, j, offset) / 2)) < 2;
}

void BlockPairs::findAt(const Ring& ring) noexcept {
  const BlockPyramid::Level& level = pyramid_.levels()[ring.level];
  const Offset& offset = ring.offset;
  const auto boxes = [this](std::size_t first) {
    const auto &low = pyramid_.lows(), &high = pyramid_.highs();
    return Boxes{{&low[0][first], &low[1][first], &low[2][first]}, {&high[0][first], &high[1][first], &high[2][first]}};
  };
  for (int i = 0; i + offset.down < level.rows; ++i) {
    const std::vector<std::uint8_t>& needed = ring.needed[static_cast<std::size_t>(i % 2)];
    if (!pyramid_.isRowWanted(ring.level, i) && !pyramid_.isRowWanted(ring.level, i + offset.down)) continue;
    const std::size_t first = level.at(i, 0), second = level.at(i + offset.down, offset.right);
    if (!nearPairs(boxes(first), boxes(second), needed, reach_, near_.data())) continue;
    for (std::size_t group = 0; group < needed.size(); ++group) {
      for (std::uint32_t bits = near_[group]; bits != 0; bits &= bits - 1) {
        const int j = static_cast<int>(8 * group) + __builtin_ctz(bits);
        follow(ring.level, level.at(i, j), level.at(i + offset.down, columnBeyond(level, j, offset)));
      }
    }
  }
}

// Down to quads whose boxes come near.
void BlockPairs::follow(std::size_t at_level, std::size_t a, std::size_t b) noexcept {
  if (!pyramid_.isWanted(a) && !pyramid_.isWanted(b)) return;
  if (at_level == 0) {
    full_ = full_ || found_.size() == found_.capacity();
    if (!full_) found_.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)});
    return;
  }
  const BlockPyramid::Level &level = pyramid_.levels()[at_level], &below = pyramid_.levels()[at_level - 1];
  const auto childrenNear = [&](std::size_t block, std::size_t other, std::array<std::size_t, 4>& children) {
    const int i = level.rowOf(block), j = level.columnOf(block);
    std::size_t count = 0;
    for (int row = 2 * i; row < std::min(2 * i + 2, below.rows); ++row) {
      for (int column = 2 * j; column < std::min(2 * j + 2, below.columns); ++column) {
        children[count] = below.at(row, column);
        count += pyramid_.meet(children[count], other, reach_) ? 1 : 0;
      }
    }
    return count;
  };
  std::array<std::size_t, 4> of_a, of_b;
  const std::size_t count_a = childrenNear(a, b, of_a), count_b = count_a == 0 ? 0 : childrenNear(b, a, of_b);
  for (std::size_t k = 0; k < count_a; ++k) {
    for (std::size_t l = 0; l < count_b; ++l) {
      if (pyramid_.meet(of_a[k], of_b[l], reach_)) follow(at_level - 1, of_a[k], of_b[l]);
    }
  }
}

bool BlockPairs::find(float reach) noexcept {
  reach_ = reach;
  full_ = false;
  found_.clear();
  for (const Ring& ring : rings_) findAt(ring);
  return !full_;
}

}  // namespace curtain
