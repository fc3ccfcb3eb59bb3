// SPDX-License-Identifier: BSD-3-Clause
//
// Gaps between cloths that lie side by side in one grid: columns of quads without any cloth, which may be as wide as
// the cloths are apart. What owns elements at a gap's sides are the quads beside it, as at the grid's borders. Where
// they are too few, the gap's own quads do, as if they were cloth.
#pragma once

#include <cstddef>
#include <vector>

#include "cloth/field.h"

namespace curtain {

class Gaps {
 public:
  /// wide: columns of quads that there must be between two of them.
  Gaps(const Grid& grid, int wide) : gap_(static_cast<std::size_t>(grid.columns) + 1, false) {
    if (grid.slit_row.empty() || grid.closed) return;
    int before = -1;  // the last column of quads without cloth
    for (int quad = 0; quad + 1 < grid.columns; ++quad) {
      if (!isCut(grid, quad)) continue;
      int next = quad + 1;
      while (next + 1 < grid.columns && !isCut(grid, next)) ++next;
      gap_[static_cast<std::size_t>(quad)] = quad - before > wide && next - quad > wide;
      any_ = any_ || at(quad);
      before = quad;
    }
  }

  bool any() const noexcept { return any_; }
  /// A column of quads, by the column of nodes on its left, is a gap.
  bool at(int quad) const noexcept { return gap_[static_cast<std::size_t>(quad)]; }

 private:
  static bool isCut(const Grid& grid, int quad) { return grid.slit_row[static_cast<std::size_t>(quad) + 1] == 0; }

  std::vector<bool> gap_;
  bool any_ = false;
};

}  // namespace curtain
