// SPDX-License-Identifier: BSD-3-Clause
#include "parts/bending/rest_curvature.h"

#include <algorithm>
#include <cmath>

namespace curtain {
RestCurvature::RestCurvature(const ClothPattern& pattern, bool warp) : pattern_(pattern), warp_(warp) {
  const Field& turn = warp ? pattern.warp_rest_turn : pattern.weft_rest_turn;
  couples_.reserve(
      static_cast<std::size_t>(std::count_if(turn.begin(), turn.end(), [](double angle) { return angle != 0.0; })));
  fill();
}

void RestCurvature::fill() noexcept {
  const Field& turn = warp_ ? pattern_.warp_rest_turn : pattern_.weft_rest_turn;
  const Field& stiffness = warp_ ? pattern_.warp_bending : pattern_.weft_bending;
  couples_.clear();
  constant_ = 0.0;
  if (turn.empty() || stiffness.empty()) return;
  const Grid& grid = pattern_.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      const double k = stiffness[n], angle = turn[n];
      if (k == 0.0 || angle == 0.0) continue;
      const Couple couple{turningJoint(pattern_, warp_, i, j), k * std::sin(angle), k * (1.0 - std::cos(angle))};
      constant_ += couple.constant;
      couples_.push_back(couple);
    }
  }
}

double RestCurvature::addTo(const Field3& position, Field3& force) const noexcept {
  double energy = 0.0;
  for (const Couple& couple : couples_) {
    const Turn turn = turnOf(couple.joint, position);
    energy += couple.constant;
    energy -= couple.moment * turn.sine;
    addCouple(couple.joint, turn, couple.moment, force);
  }
  return energy;
}

}  // namespace curtain
