// SPDX-License-Identifier: BSD-3-Clause
//
// What further rows change is taken up together with the changes of the strings, and of the rods.
#include <algorithm>
#include <cmath>

#include "cloth/wide.h"
#include "step/constants.h"
#include "step/constraints.h"

namespace curtain {

namespace {

CURTAIN_WIDE double largestSquare(const Field3& moved) noexcept {
  const ConstFieldView m(moved, 0);
  const std::size_t count = moved.x.size();
  double most = 0.0;
#pragma omp simd reduction(max : most)
  for (std::size_t n = 0; n < count; ++n) {
    const double square = m.x[n] * m.x[n] + m.y[n] * m.y[n] + m.z[n] * m.z[n];
    most = most > square ? most : square;
  }
  return most;
}

CURTAIN_WIDE void addShare(double share, const Field& change, Field& value) noexcept {
  const double* const c = change.data();
  double* const v = value.data();
  const std::size_t count = change.size();
#pragma omp simd
  for (std::size_t n = 0; n < count; ++n) v[n] += share * c[n];
}

// A string never pushes.
CURTAIN_WIDE void boundChange(const Field& multiplier, Field& change) noexcept {
  const double* const s = multiplier.data();
  double* const c = change.data();
  const std::size_t count = change.size();
#pragma omp simd
  for (std::size_t n = 0; n < count; ++n) c[n] = c[n] < -s[n] ? -s[n] : c[n];
}

}  // namespace

// A load of 25 times the cloth's weight pulls its node off by metres in a substep, and a bar under one pushes its nodes
// as far, if the rods do not pull them back at once. So nodes are moved by the sum, or by a share of it if that is
// large. Returns the share.
double Constraints::applyTogether() noexcept {
  const Grid& grid = pattern_.grid;
  const Field& inverse = inertia_.inverse();
  for (Field* axis : {&moved_.x, &moved_.y, &moved_.z}) std::fill(axis->begin(), axis->end(), 0.0);
  boundChange(weft_.multiplier, change_);
  const LineSolve weft{pattern_, inverse, weft_, moved_, guided()}, warp{pattern_, inverse, warp_, moved_, guided()};
  for (int i = 0; i < grid.rows; ++i) pullWeft(weft, i, change_);
  net_.rodsAnswer(change_, rows_, rod_change_);
  for (const Row& row : rows_) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.nodes); ++k)
      moved_.add(row.node[k], (inverse[row.node[k]] * row.weight[k] * row.change) * row.direction);
  }
  forEachBlock([&](int block) { pullWarp(warp, block, rod_change_); });
  const double move = std::sqrt(largestSquare(moved_)) / middle_rest_;
  const double share = move > kLargestMove ? kLargestMove / move : 1.0;
  addShare(share, moved_.x, next.x);
  addShare(share, moved_.y, next.y);
  addShare(share, moved_.z, next.z);
  addShare(share, change_, weft_.multiplier);
  addShare(share, rod_change_, warp_.multiplier);
  return share;
}

}  // namespace curtain
