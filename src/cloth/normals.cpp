// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/cloth.h"
#include "cloth/wide.h"

namespace curtain {

// The corner triangles of the (up to four) faces at a node add up to one cross product of differences:
//   sum over quadrants of (warp edge) x (weft edge) = (x_below - x_above) x (x_right - x_left),
// with the node itself in place of a missing neighbour.
CURTAIN_WIDE void nodeAreaVectors(const Grid& grid, int i, const Field3& position, Field3& out) noexcept {
  const auto last = static_cast<std::size_t>(grid.columns) - 1;
  const ConstFieldView above(position, grid.row(i > 0 ? i - 1 : i));
  const ConstFieldView below(position, grid.row(i + 1 < grid.rows ? i + 1 : i));
  const ConstFieldView here(position, grid.row(i));
  const FieldView o(out, grid.row(i));
  const auto node = [=](std::size_t j, std::size_t left, std::size_t right) {
    const double px = below.x[j] - above.x[j], qx = here.x[right] - here.x[left];
    const double py = below.y[j] - above.y[j], qy = here.y[right] - here.y[left];
    const double pz = below.z[j] - above.z[j], qz = here.z[right] - here.z[left];
    o.x[j] = 0.5 * (py * qz - pz * qy);
    o.y[j] = 0.5 * (pz * qx - px * qz);
    o.z[j] = 0.5 * (px * qy - py * qx);
  };
  node(0, grid.closed ? last : 0, 1);
#pragma omp simd
  for (std::size_t j = 1; j < last; ++j) node(j, j - 1, j + 1);
  node(last, last - 1, grid.closed ? 0 : last);
  if (grid.slit_row.empty()) return;
  const auto columns = static_cast<std::size_t>(grid.columns);
  for (std::size_t j = 0; j < columns; ++j) {
    const std::size_t left = (j + columns - 1) % columns, right = (j + 1) % columns;
    const bool on_left = grid.hasLink(i, static_cast<int>(j)), on_right = grid.hasLink(i, static_cast<int>(right));
    if (!on_left || !on_right) node(j, on_left ? left : j, on_right ? right : j);
  }
}

void nodeAreaVectors(const Grid& grid, const Field3& position, Field3& out) noexcept {
  for (int i = 0; i < grid.rows; ++i) nodeAreaVectors(grid, i, position, out);
}

}  // namespace curtain
