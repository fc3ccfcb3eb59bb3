// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/windows.h"

#include <algorithm>

#include "contact/narrow_phase/flatness.h"

namespace curtain {
namespace {

double meanWeft(const ClothPattern& pattern, int link) {
  const Grid& grid = pattern.grid;
  double sum = 0.0;
  for (int i = 0; i < grid.rows; ++i) sum += pattern.weft_rest[grid.index(i, (link + 1) % grid.columns)];
  return sum / grid.rows;
}

double meanWarp(const ClothPattern& pattern, int rod) {
  const Grid& grid = pattern.grid;
  double sum = 0.0;
  for (int j = 0; j < grid.columns; ++j) sum += pattern.warp_rest[grid.index(rod + 1, j)];
  return sum / grid.columns;
}

}  // namespace

Windows::Windows(const ClothPattern& pattern, const ElementPairs& elements)
    : grid_(pattern.grid),
      elements_(elements),
      high_(std::min(2, grid_.rows - 1)),
      wide_(std::min(2, grid_.linkCount())),
      rows_(grid_.rows - high_),
      columns_(grid_.closed ? grid_.columns : grid_.columns - wide_) {
  const int quads = grid_.linkCount();
  per_spacing_u_.assign(static_cast<std::size_t>(quads) + 1 + EvenWindows::kCount, 1.0f);
  for (int j = 0; j < quads + (grid_.closed ? 1 : 0); ++j) {
    per_spacing_u_[static_cast<std::size_t>(j)] = static_cast<float>(1.0 / meanWeft(pattern, j % quads));
  }
  per_spacing_v_.assign(static_cast<std::size_t>(grid_.rows), 1.0f);
  for (int i = 0; i + 1 < grid_.rows; ++i) per_spacing_v_[static_cast<std::size_t>(i)] = static_cast<float>(1.0 / meanWarp(pattern, i));
  bent_.reserve(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_));
  makeLocalPairs();
}

void Windows::makeLocalPairs() {
  if (rows_ < 2 || grid_.columns < 4) return;
  const ElementPairs all(grid_);
  const auto addTo = [this](std::vector<LocalPair>& pairs) {
    return [this, &pairs](const FourNodes& nodes) {
      LocalPair local;
      for (std::size_t k = 0; k < 4; ++k) {
        const auto stride = static_cast<std::uint32_t>(grid_.stride);
        local[k] = static_cast<std::uint8_t>(nodes[k] / stride * 3 + nodes[k] % stride);
      }
      pairs.push_back(local);
    };
  };
  const int quads[5][4] = {{0, 0, 0, 0}, {0, 0, 0, 1}, {0, 0, 1, 0}, {0, 0, 1, 1}, {0, 1, 1, 0}};
  for (const auto& [row_p, column_p, row_q, column_q] : quads) all.forEach(row_p, column_p, row_q, column_q, addTo(vertices_), addTo(edges_));
}

void Windows::find(const MovingNodes& nodes, const BlockPyramid& pyramid, float reach, float rounding) noexcept {
  bent_.clear();
  for (int i = 0; i < rows_; ++i) {
    if (!pyramid.areRowsAsked(0, i, i + high_ - 1)) continue;
    for (int j = 0; j < columns_; j += static_cast<int>(EvenWindows::kCount)) {
      const std::size_t node = static_cast<std::size_t>(i) * nodes.stride + static_cast<std::size_t>(j);
      const EvenWindows windows{high_, wide_, nodes.stride,
                                {{&nodes.start[0][node], &nodes.start[1][node], &nodes.start[2][node]}, {&nodes.end[0][node], &nodes.end[1][node], &nodes.end[2][node]}},
                                &per_spacing_u_[static_cast<std::size_t>(j)], &per_spacing_v_[static_cast<std::size_t>(i)], reach, rounding};
      const std::uint32_t count = std::min(static_cast<std::uint32_t>(columns_ - j), static_cast<std::uint32_t>(EvenWindows::kCount));
      for (std::uint32_t bent = ~windows.find() & ((1U << count) - 1U); bent != 0; bent &= bent - 1) {
        bent_.push_back({i, j + __builtin_ctz(bent)});
      }
    }
  }
}

}  // namespace curtain
