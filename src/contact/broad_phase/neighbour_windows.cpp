// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/neighbour_windows.h"

#include <algorithm>

namespace curtain {

Windows::Windows(const Grid& grid, const Spacings& per_spacing, const ElementPairs& elements)
    : grid_(grid),
      elements_(elements),
      per_spacing_(per_spacing),
      high_(std::min(2, grid_.rows - 1)),
      wide_(std::min(2, grid_.linkCount())),
      rows_(grid_.rows - high_),
      columns_(grid_.closed ? grid_.columns : grid_.columns - wide_) {
  bent_.reserve(static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_));
  makeLocalPairs();
}

void Windows::makeLocalPairs() {
  if (rows_ < 2 || grid_.columns < 4) return;
  const ElementPairs all(Grid(grid_.rows, grid_.columns, grid_.closed));
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
  for (const auto& [row_p, column_p, row_q, column_q] : quads)
    all.forEach(row_p, column_p, row_q, column_q, addTo(vertices_), addTo(edges_));
}

void Windows::find(const MovingNodes& nodes, const BoxHierarchy& hierarchy, float reach, float rounding) noexcept {
  bent_.clear();
  for (int i = 0; i < rows_; ++i) {
    if (!hierarchy.areRowsWanted(0, i, i + high_ - 1)) continue;
    for (int j = 0; j < columns_; j += static_cast<int>(FlatWindows::kCount)) {
      const std::size_t node = static_cast<std::size_t>(i) * nodes.stride + static_cast<std::size_t>(j);
      const FlatWindows windows{high_,
                                wide_,
                                nodes.stride,
                                {{&nodes.start[0][node], &nodes.start[1][node], &nodes.start[2][node]},
                                 {&nodes.end[0][node], &nodes.end[1][node], &nodes.end[2][node]}},
                                &per_spacing_.u[static_cast<std::size_t>(j)],
                                &per_spacing_.v[static_cast<std::size_t>(i)],
                                reach,
                                rounding};
      const std::uint32_t count =
          std::min(static_cast<std::uint32_t>(columns_ - j), static_cast<std::uint32_t>(FlatWindows::kCount));
      for (std::uint32_t bent = ~windows.find() & ((1U << count) - 1U); bent != 0; bent &= bent - 1) {
        bent_.push_back({i, j + __builtin_ctz(bent)});
      }
    }
  }
}

}  // namespace curtain
