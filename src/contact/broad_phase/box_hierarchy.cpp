// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/box_hierarchy.h"

#include <algorithm>
#include <cstring>

#include "cloth/shuffle.h"
#include "cloth/wide.h"

namespace curtain {
namespace {

// Padding [floats] at either end of the arrays, so that vector loads stay inside.
constexpr std::size_t kBeyond = 16;
constexpr int kMostAtTop = 4;
constexpr float kNowhere = 1e30f;

// Ranges of a row of quads along one axis, from the rows of nodes above and below at both instants.
CURTAIN_WIDE void rangesOfQuads(const float* __restrict start, const float* __restrict end, std::size_t stride,
                                std::size_t count, float* __restrict low, float* __restrict high) {
  const auto least = [](float a, float b) { return a < b ? a : b; };
  const auto most = [](float a, float b) { return a < b ? b : a; };
#pragma omp simd
  for (std::size_t j = 0; j < count; ++j) {
    const float a = start[j], b = start[j + 1], c = start[stride + j], d = start[stride + j + 1];
    const float e = end[j], f = end[j + 1], g = end[stride + j], h = end[stride + j + 1];
    low[j] = least(least(least(a, b), least(c, d)), least(least(e, f), least(g, h)));
    high[j] = most(most(most(a, b), most(c, d)), most(most(e, f), most(g, h)));
  }
}

// Ranges of a row of blocks along one axis, from the two rows of their children (the same one twice at the border).
CURTAIN_WIDE void rangesOfBlocks(const float* __restrict low_above, const float* __restrict low_below,
                                 const float* __restrict high_above, const float* __restrict high_below,
                                 std::size_t count, float* __restrict low, float* __restrict high) {
  const auto least = [](float a, float b) { return a < b ? a : b; };
  const auto most = [](float a, float b) { return a < b ? b : a; };
#pragma omp simd
  for (std::size_t j = 0; j < count; ++j) {
    low[j] = least(least(low_above[2 * j], low_above[2 * j + 1]), least(low_below[2 * j], low_below[2 * j + 1]));
    high[j] = most(most(high_above[2 * j], high_above[2 * j + 1]), most(high_below[2 * j], high_below[2 * j + 1]));
  }
}

// From structure of arrays to one box after the other: low and high, four floats each. Handles multiples of four
// boxes.
CURTAIN_WIDE void interleave(const std::array<const float*, 3>& low, const std::array<const float*, 3>& high,
                             std::size_t count, float* boxes) {
  using Four = float __attribute__((vector_size(16)));
  const auto across = [&](const std::array<const float*, 3>& from, std::size_t k, float* to) {
    Four x, y, z, zero = Four{};
    std::memcpy(&x, from[0] + k, sizeof x);
    std::memcpy(&y, from[1] + k, sizeof y);
    std::memcpy(&z, from[2] + k, sizeof z);
    Four xy, xy_high, z_zero, z_high, out[4];
    shuffle<0, 4, 1, 5>(x, y, xy);
    shuffle<2, 6, 3, 7>(x, y, xy_high);
    shuffle<0, 4, 1, 5>(z, zero, z_zero);
    shuffle<2, 6, 3, 7>(z, zero, z_high);
    shuffle<0, 1, 4, 5>(xy, z_zero, out[0]);
    shuffle<2, 3, 6, 7>(xy, z_zero, out[1]);
    shuffle<0, 1, 4, 5>(xy_high, z_high, out[2]);
    shuffle<2, 3, 6, 7>(xy_high, z_high, out[3]);
    for (std::size_t box = 0; box < 4; ++box) std::memcpy(to + 8 * box, &out[box], sizeof out[box]);
  };
  for (std::size_t k = 0; k < count; k += 4) {
    across(low, k, boxes + 8 * k);
    across(high, k, boxes + 8 * k + 4);
  }
}

}  // namespace

BoxHierarchy::BoxHierarchy(const Grid& grid) : grid_(grid) {
  std::size_t size = kBeyond;
  for (int rows = grid.rows - 1, columns = grid.linkCount();; rows = (rows + 1) / 2, columns = (columns + 1) / 2) {
    const auto wide = static_cast<std::size_t>(columns + (grid.closed ? 2 : 1) * kMostOffset);
    const std::size_t stride = (wide + 7) / 8 * 8;
    levels_.push_back({rows, columns, size, stride});
    selected_rows_.emplace_back(static_cast<std::size_t>(rows), std::uint8_t{kMarked | kBent});
    size += (static_cast<std::size_t>(rows) + kMostOffset + 1) * stride;
    if (rows <= kMostAtTop && columns <= kMostAtTop) break;
  }
  size += kBeyond;
  for (std::size_t k = 0; k < 3; ++k) {
    lows_[k].assign(size, kNowhere);
    highs_[k].assign(size, -kNowhere);
  }
  selected_.assign(size, kMarked | kBent);
  boxes_.assign(size, {Eigen::Array4f::Zero(), Eigen::Array4f::Zero()});
}

void BoxHierarchy::wrapAround(const Level& level, Floats& values) const noexcept {
  if (!grid_.closed) return;
  const auto columns = static_cast<std::ptrdiff_t>(level.columns);
  for (int i = 0; i < level.rows; ++i) {
    float* const row = &values[level.at(i, 0)];
    for (std::ptrdiff_t j = 0; j < kMostOffset; ++j) {
      row[columns + j] = row[j % columns];
      row[-1 - j] = row[columns - 1 - j % columns];
    }
  }
}

void BoxHierarchy::refitBelow(std::size_t level, const MovingNodes& nodes) noexcept {
  if (level > 0) boxesOfQuads(nodes);
  mergeUpwards(1, level);
}

void BoxHierarchy::interleaveBoxes() noexcept {
  for (const Level& level : levels_) {
    interleave({&lows_[0][level.first], &lows_[1][level.first], &lows_[2][level.first]},
               {&highs_[0][level.first], &highs_[1][level.first], &highs_[2][level.first]},
               static_cast<std::size_t>(level.rows) * level.stride, boxes_[level.first].low.data());
  }
}

void BoxHierarchy::select(const std::vector<std::uint8_t>* marked) noexcept {
  constexpr std::uint8_t kAll = kMarked | kBent;
  std::fill(selected_.begin(), selected_.end(), kAll);
  for (std::vector<std::uint8_t>& rows : selected_rows_) std::fill(rows.begin(), rows.end(), kAll);
  if (marked == nullptr) return;
  selectMarked(*marked);
  selectRows();
}

void BoxHierarchy::selectMarked(const std::vector<std::uint8_t>& marked) noexcept {
  const auto set = [this](std::size_t block, bool on) { selected_[block] = on ? kMarked | kBent : kBent; };
  const Level& quads = levels_.front();
  for (int i = 0; i < quads.rows; ++i) {
    for (int j = 0; j < quads.columns; ++j) {
      const int right = j + 1 < grid_.columns ? j + 1 : 0;
      set(quads.at(i, j), (marked[grid_.index(i, j)] | marked[grid_.index(i, right)] | marked[grid_.index(i + 1, j)] |
                           marked[grid_.index(i + 1, right)]) != 0);
    }
  }
  for (std::size_t at_level = 1; at_level < levels_.size(); ++at_level) {
    const Level &level = levels_[at_level], &below = levels_[at_level - 1];
    for (int i = 0; i < level.rows; ++i) {
      for (int j = 0; j < level.columns; ++j) {
        const int row = std::min(2 * i + 1, below.rows - 1), column = std::min(2 * j + 1, below.columns - 1);
        const auto at = [&](int k, int l) { return selected_[below.at(k, l)]; };
        set(level.at(i, j), ((at(2 * i, 2 * j) | at(2 * i, column) | at(row, 2 * j) | at(row, column)) & kMarked) != 0);
      }
    }
  }
}

void BoxHierarchy::excludeWithin(std::size_t at_level, int row, int column) noexcept {
  for (std::size_t level = 0; level < at_level; ++level) {
    const Level& blocks = levels_[level];
    const int along = 1 << (at_level - level);
    for (int i = row * along; i < std::min((row + 1) * along, blocks.rows); ++i) {
      for (int j = column * along; j < std::min((column + 1) * along, blocks.columns); ++j)
        selected_[blocks.at(i, j)] &= kMarked;
    }
  }
}

void BoxHierarchy::selectRows() noexcept {
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    for (int i = 0; i < levels_[level].rows; ++i) {
      std::uint8_t any = 0;
      for (int j = 0; j < levels_[level].columns; ++j)
        any = static_cast<std::uint8_t>(any | selected_[levels_[level].at(i, j)]);
      selected_rows_[level][static_cast<std::size_t>(i)] = any;
    }
  }
}

void BoxHierarchy::boxesOfQuads(const MovingNodes& nodes) noexcept {
  const Level& level = levels_.front();
  for (std::size_t k = 0; k < 3; ++k) {
    for (int i = 0; i < level.rows; ++i) {
      const std::size_t from = static_cast<std::size_t>(i) * nodes.stride, to = level.at(i, 0);
      rangesOfQuads(&nodes.start[k][from], &nodes.end[k][from], nodes.stride, static_cast<std::size_t>(level.columns),
                    &lows_[k][to], &highs_[k][to]);
    }
    wrapAround(level, lows_[k]);
    wrapAround(level, highs_[k]);
  }
}

// Merges levels [from, to) from their children.
void BoxHierarchy::mergeUpwards(std::size_t from, std::size_t to) noexcept {
  for (std::size_t at_level = from; at_level < to; ++at_level) {
    const Level &level = levels_[at_level], &below = levels_[at_level - 1];
    const auto pairs = static_cast<std::size_t>(below.columns / 2);
    for (std::size_t k = 0; k < 3; ++k) {
      for (int i = 0; i < level.rows; ++i) {
        const std::size_t first = below.at(2 * i, 0), second = below.at(std::min(2 * i + 1, below.rows - 1), 0),
                          place = level.at(i, 0);
        rangesOfBlocks(&lows_[k][first], &lows_[k][second], &highs_[k][first], &highs_[k][second], pairs,
                       &lows_[k][place], &highs_[k][place]);
        if (below.columns % 2 == 0) continue;
        lows_[k][place + pairs] = std::min(lows_[k][first + 2 * pairs], lows_[k][second + 2 * pairs]);
        highs_[k][place + pairs] = std::max(highs_[k][first + 2 * pairs], highs_[k][second + 2 * pairs]);
      }
      wrapAround(level, lows_[k]);
      wrapAround(level, highs_[k]);
    }
  }
}

}  // namespace curtain
