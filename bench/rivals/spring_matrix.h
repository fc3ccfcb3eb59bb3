// SPDX-License-Identifier: BSD-3-Clause
//
// The matrix M - h^2 df/dx of linear springs, one symmetric 3x3 block a link, and its block-diagonal preconditioner.
#pragma once

#include <array>
#include <vector>

#include "bench/rivals/grid_state.h"

namespace curtain_bench {

class SpringMatrix {
 public:
  explicit SpringMatrix(const GridState& state);

  /// Blocks at the state's positions. What a compressed spring takes away across itself is left out, so that the matrix
  /// is positive definite (Choi, Ko 2002, Sect. 4).
  void linearise(const GridState& state, double stiffness, double h);

  /// out = -h^2 df/dx in; pinned nodes are not filtered.
  void multiplyLinks(const GridState& state, const Triple& in, Triple& out) const;

  /// out = S (M - h^2 df/dx) in, S the filter of pinned nodes; in must be zero there (Baraff, Witkin 1998, Sect. 5.3).
  void multiply(const GridState& state, const Triple& in, Triple& out) const;

  /// out = S P in, P the inverse of the diagonal blocks.
  void precondition(const GridState& state, const Triple& in, Triple& out) const;

 private:
  void invertDiagonal(const GridState& state);

  /// xx, xy, xz, yy, yz, zz of h^2 K, a link each, and of the diagonal's inverse, a node each.
  std::array<std::vector<double>, 6> block_, inverse_;
};

}  // namespace curtain_bench
