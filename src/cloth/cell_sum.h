// SPDX-License-Identifier: BSD-3-Clause
//
// Sums over the cells of the cloth at its nodes: each cell does something to its four corners. Blocks of rows are
// independent, so that workers share them; the cells between two blocks are computed in both.
#pragma once

#include <algorithm>
#include <vector>

#include "cloth/field.h"
#include "cloth/workers.h"

namespace curtain {

/// What the cells of a row do to their corners, by the column on the right of each; shape [columns].
struct CellCorners {
  Field3 top_left, top_right, bottom_left, bottom_right;
};

/// Not thread-safe. Allocates only in the constructor.
class CellSum {
 public:
  explicit CellSum(const Grid& grid);

  /// Adds to `sum`. fill(row, corners): of the cells between this row and the next; corners without a cell: 0.
  template <typename Fill>
  void add(const Grid& grid, const Workers& workers, const Fill& fill, Field3& sum) noexcept {
    workers.run(static_cast<int>(blocks_.size()), [&](int block) {
      CellCorners& corners = blocks_[static_cast<std::size_t>(block)];
      const int begin = block * kRows, end = std::min(begin + kRows, grid.rows);
      for (int i = std::max(0, begin - 1); i < std::min(end, grid.rows - 1); ++i) {
        fill(i, corners);
        if (i >= begin) addRow(corners.top_left, corners.top_right, grid, i, sum);
        if (i + 1 < end) addRow(corners.bottom_left, corners.bottom_right, grid, i + 1, sum);
      }
    });
  }

 private:
  static constexpr int kRows = 8;  // of a block
  static void addRow(const Field3& left, const Field3& right, const Grid& grid, int row, Field3& sum) noexcept;

  std::vector<CellCorners> blocks_;
};

}  // namespace curtain
