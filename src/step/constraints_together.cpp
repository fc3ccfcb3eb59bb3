// SPDX-License-Identifier: BSD-3-Clause
//
// What further rows change is taken up together with the changes of the strings, and of the rods.
#include <cmath>

#include "step/constants.h"
#include "step/constraints.h"

namespace curtain {

// A load of 25 times the cloth's weight pulls its node off by metres in a substep, and a bar under one pushes its nodes
// as far, if the rods do not pull them back at once. So nodes are moved by the sum, or by a share of it if that is
// large. Returns the share.
double Constraints::takeUpTogether() noexcept {
  const Grid& grid = pattern_.grid;
  const Field& inverse = inertia_.inverse();
  for (Field* axis : {&moved_.x, &moved_.y, &moved_.z}) std::fill(axis->begin(), axis->end(), 0.0);
  for (std::size_t n = 0; n < grid.size(); ++n) change_[n] = std::max(change_[n], -weft_.multiplier[n]);
  const LineSolve weft{pattern_, inverse, weft_, moved_, guided()};
  for (int i = 0; i < grid.rows; ++i) pullWeft(weft, i, change_);
  net_.rodsAnswer(change_, rows_, rod_change_);
  for (const Row& row : rows_) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(row.nodes); ++k)
      moved_.add(row.node[k], (inverse[row.node[k]] * row.weight[k] * row.change) * row.direction);
  }
  const auto stride = static_cast<std::size_t>(grid.stride);
  double most = 0.0;
  for (std::size_t n = 0; n < grid.size(); ++n) {
    if (n >= stride && n < grid.row(grid.rows)) {
      const Vec3 pull = rod_change_[n] * warp_.direction.at(n);
      moved_.add(n - stride, inverse[n - stride] * pull);
      moved_.add(n, -inverse[n] * pull);
    }
  }
  for (std::size_t n = 0; n < grid.size(); ++n) most = std::max(most, moved_.at(n).squaredNorm());
  const double move = std::sqrt(most) / middle_rest_;
  const double share = move > kLargestMove ? kLargestMove / move : 1.0;
  for (std::size_t n = 0; n < grid.size(); ++n) {
    next.add(n, share * moved_.at(n));
    weft_.multiplier[n] += share * change_[n];
    warp_.multiplier[n] += share * rod_change_[n];
  }
  return share;
}

}  // namespace curtain
