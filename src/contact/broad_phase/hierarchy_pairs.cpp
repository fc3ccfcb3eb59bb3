// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/hierarchy_pairs.h"

#include <algorithm>
#include <cstdlib>

#include "contact/narrow_phase/simd8.h"

namespace curtain {
namespace {

struct Boxes {
  const float *low[3], *high[3];
};

// Tests rows of boxes against each other: sets in `near` the bits of the needed pairs that are within reach along
// every axis. Returns whether there are any.
CURTAIN_WIDE bool nearPairs(const Boxes& p, const Boxes& q, const std::vector<std::uint8_t>& needed, float reach,
                            std::uint8_t* near) {
  std::uint32_t any = 0;
  for (std::size_t group = 0; group < needed.size(); ++group) {
    Simd8::Lanes widest = Simd8::Lanes{} - 1.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      Simd8::Lanes low_p, high_p, low_q, high_q;
      Simd8::load(p.low[k] + 8 * group, low_p);
      Simd8::load(p.high[k] + 8 * group, high_p);
      Simd8::load(q.low[k] + 8 * group, low_q);
      Simd8::load(q.high[k] + 8 * group, high_q);
      const Simd8::Lanes beyond = low_p - high_q, before = low_q - high_p;
      widest = beyond > widest ? beyond : widest;
      widest = before > widest ? before : widest;
    }
    near[group] = static_cast<std::uint8_t>(Simd8::bitsOf(widest <= reach) & needed[group]);
    any |= near[group];
  }
  return any != 0;
}

}  // namespace

HierarchyPairs::HierarchyPairs(const BoxHierarchy& hierarchy) : hierarchy_(hierarchy) { makeLevelOffsets(); }

void HierarchyPairs::makeLevelOffsets() {
  for (std::size_t level = 0; level < hierarchy_.levels().size(); ++level) {
    const BoxHierarchy::Level& blocks = hierarchy_.levels()[level];
    const auto groups = static_cast<std::size_t>(blocks.columns + 7) / 8;
    for (int down = 0; down <= std::min(BoxHierarchy::kMostOffset, blocks.rows - 1); ++down) {
      for (int right = down == 0 ? 2 : -BoxHierarchy::kMostOffset; right <= BoxHierarchy::kMostOffset; ++right) {
        if (std::max(down, std::abs(right)) < 2) continue;
        LevelOffset entry{level, {down, right}, {}};
        for (std::size_t odd = 0; odd < 2; ++odd) {
          entry.needed[odd].assign(groups, 0);
          for (int j = 0; j < blocks.columns; ++j) {
            if (!isNeeded(level, entry.offset, static_cast<int>(odd), j)) continue;
            auto& bits = entry.needed[odd][static_cast<std::size_t>(j) / 8];
            bits = static_cast<std::uint8_t>(bits | 1U << (j % 8));
          }
          if (std::all_of(entry.needed[odd].begin(), entry.needed[odd].end(),
                          [](std::uint8_t bits) { return bits == 0; }))
            entry.needed[odd].clear();
        }
        if (!entry.needed[0].empty() || !entry.needed[1].empty()) level_offsets_.push_back(std::move(entry));
      }
    }
  }
}

int HierarchyPairs::offsetColumn(const BoxHierarchy::Level& level, int j, const Offset& offset) const noexcept {
  const int k = j + offset.right;
  return hierarchy_.closed() ? (k + level.columns) % level.columns : k;
}

// Columns between the two, the shorter way around a closed cloth.
int HierarchyPairs::columnDistance(const BoxHierarchy::Level& level, int j, int k) const noexcept {
  const int apart = std::abs(k - j);
  return hierarchy_.closed() ? std::min(apart, level.columns - apart) : apart;
}

// Whether the parents of the two blocks are neighbours (the blocks are not). Depends on i by its parity only.
bool HierarchyPairs::isNeeded(std::size_t at_level, const Offset& offset, int i, int j) const noexcept {
  const BoxHierarchy::Level& level = hierarchy_.levels()[at_level];
  if (hierarchy_.closed()) {
    // Around a closed cloth a pair can be at two offsets: it is taken at one of them.
    if (2 * std::abs(offset.right) > level.columns) return false;
    if (2 * std::abs(offset.right) == level.columns &&
        (offset.down == 0 ? j + offset.right >= level.columns : offset.right < 0))
      return false;
  } else if (j + offset.right < 0 || j + offset.right >= level.columns) {
    return false;
  }
  if (at_level + 1 == hierarchy_.levels().size()) return true;
  const int rows = (i + offset.down) / 2 - i / 2;
  return std::max(rows, columnDistance(hierarchy_.levels()[at_level + 1], j / 2, offsetColumn(level, j, offset) / 2)) <
         2;
}

// Tests one row; `near` gets the bits of the pairs within reach.
bool HierarchyPairs::findNear(const LevelOffset& entry, int row, float reach, NearBits& near) const noexcept {
  const BoxHierarchy::Level& level = hierarchy_.levels()[entry.level];
  const std::vector<std::uint8_t>& needed = entry.needed[static_cast<std::size_t>(row % 2)];
  if (needed.empty() || !hierarchy_.areRowsWanted(entry.level, row, row + entry.offset.down)) return false;
  const auto boxes = [this](std::size_t first) {
    const auto &low = hierarchy_.lows(), &high = hierarchy_.highs();
    return Boxes{{&low[0][first], &low[1][first], &low[2][first]}, {&high[0][first], &high[1][first], &high[2][first]}};
  };
  return nearPairs(boxes(level.at(row, 0)), boxes(level.at(row + entry.offset.down, entry.offset.right)), needed, reach,
                   near.data());
}

// Children of a block that are within reach of another block; returns how many.
std::size_t HierarchyPairs::childrenNear(std::size_t at_level, std::size_t block, std::size_t other, float reach,
                                         std::array<std::size_t, 4>& children) const noexcept {
  const BoxHierarchy::Level &level = hierarchy_.levels()[at_level], &below = hierarchy_.levels()[at_level - 1];
  const int i = level.rowOf(block), j = level.columnOf(block);
  std::size_t count = 0;
  for (int row = 2 * i; row < std::min(2 * i + 2, below.rows); ++row) {
    for (int column = 2 * j; column < std::min(2 * j + 2, below.columns); ++column) {
      const std::size_t child = below.at(row, column);
      if (hierarchy_.meet(child, other, reach)) children[count++] = child;
    }
  }
  return count;
}

bool HierarchyPairs::any(float reach, std::size_t from_level) const noexcept {
  bool found = false;
  for (const LevelOffset& entry : level_offsets_) {
    if (entry.level >= from_level) findAt(entry, reach, Share(), [&](std::size_t, std::size_t) { found = true; });
  }
  return found;
}

}  // namespace curtain
