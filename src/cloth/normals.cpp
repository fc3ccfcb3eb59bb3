// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/cloth.h"

namespace curtain {

// The corner triangles of the (up to four) faces at a node add up to one cross product of differences:
//   sum over quadrants of (warp edge) x (weft edge) = (x_below - x_above) x (x_right - x_left),
// with the node itself in place of a neighbour that is missing.
void nodeAreaVectors(const Grid& grid, const Field3& position, Field3& out) {
  for (int i = 0; i < grid.rows; ++i) {
    const int above = i > 0 ? i - 1 : i;
    const int below = i + 1 < grid.rows ? i + 1 : i;
    for (int j = 0; j < grid.columns; ++j) {
      int left = j - 1;
      int right = j + 1;
      if (left < 0) left = grid.closed ? grid.columns - 1 : 0;
      if (right == grid.columns) right = grid.closed ? 0 : j;
      const std::size_t a = grid.index(above, j), b = grid.index(below, j);
      const std::size_t l = grid.index(i, left), r = grid.index(i, right);
      const double px = position.x[b] - position.x[a], qx = position.x[r] - position.x[l];
      const double py = position.y[b] - position.y[a], qy = position.y[r] - position.y[l];
      const double pz = position.z[b] - position.z[a], qz = position.z[r] - position.z[l];
      const std::size_t node = grid.index(i, j);
      out.x[node] = 0.5 * (py * qz - pz * qy);
      out.y[node] = 0.5 * (pz * qx - px * qz);
      out.z[node] = 0.5 * (px * qy - py * qx);
    }
  }
}

}  // namespace curtain
