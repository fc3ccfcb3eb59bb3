// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/cell_sum.h"

#include "cloth/wide.h"

namespace curtain {
namespace {

// left, right: of the cell on the right of a node, at whose left corner it is, and on its left.
CURTAIN_INTO_WIDE void addCorners(const Field& left, const Field& right, std::size_t columns, bool closed,
                                  double* sum) noexcept {
  const double *const l = left.data(), *const r = right.data();
  const std::size_t last = columns - 1;
#pragma omp simd
  for (std::size_t j = 0; j < last; ++j) sum[j] += r[j] + l[j + 1];
  sum[last] += closed ? r[last] + l[0] : r[last];
}

}  // namespace

CellSum::CellSum(const Grid& grid) : blocks_(static_cast<std::size_t>((grid.rows + kRows - 1) / kRows)) {
  for (CellCorners& block : blocks_) {
    for (Field3* const field : {&block.top_left, &block.top_right, &block.bottom_left, &block.bottom_right})
      field->assign(static_cast<std::size_t>(grid.stride) + 1, 0.0);
  }
}

CURTAIN_WIDE void CellSum::addRow(const Field3& left, const Field3& right, const Grid& grid, int row,
                                  Field3& sum) noexcept {
  const auto columns = static_cast<std::size_t>(grid.columns);
  const std::size_t first = grid.row(row);
  addCorners(left.x, right.x, columns, grid.closed, sum.x.data() + first);
  addCorners(left.y, right.y, columns, grid.closed, sum.y.data() + first);
  addCorners(left.z, right.z, columns, grid.closed, sum.z.data() + first);
}

}  // namespace curtain
