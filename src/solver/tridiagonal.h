// SPDX-License-Identifier: BSD-3-Clause
//
// A tridiagonal system, open or cyclic, solved without pivoting: the matrices here are those of taut lines, close to
// symmetric and positive. A pivot that vanishes leaves its unknown zero and is reported.
#pragma once

#include <cstddef>

#include "cloth/field.h"

namespace curtain {

struct TridiagonalSystem {
  Field lower, diagonal, upper;  ///< lower[0] and upper[count - 1] are the corners of a cyclic system
  Field smallest;                ///< pivots not above this are taken for zero
  Field rhs;                     ///< right-hand side; the solution after solve()

  /// Room for so many unknowns.
  explicit TridiagonalSystem(std::size_t capacity);

  /// Solves for the first `count` unknowns (cyclic: count >= 3). False: a pivot vanished. Spends the diagonal.
  bool solve(std::size_t count, bool cyclic) noexcept;

 private:
  bool sweep(std::size_t count, Field& solution) noexcept;
  Field elimination_;
  Field corner_;
};

}  // namespace curtain
