// SPDX-License-Identifier: BSD-3-Clause
#include "forces/air_damping.h"

#include <cmath>

namespace curtain {

double dampingGrowth(const AirParams& air, double speed) {
  double growth = 1.0 + air.fast_gain * speed;
  if (speed > air.threshold) {
    // Cheng 2000, Eq. (4), second branch. Printed it jumps at the threshold; divided by the threshold it does not.
    growth *= air.law == DampingLaw::kPrinted ? speed : speed / air.threshold;
  }
  return growth;
}

AirDamping::AirDamping(const AirParams& air, const ClothPattern& pattern) : air_(air) {
  const Grid& grid = pattern.grid;
  linear_.assign(grid.size(), 0.0);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const bool on_row_edge = i == 0 || i + 1 == grid.rows;
      const bool on_column_edge = !grid.closed && (j == 0 || j + 1 == grid.columns);
      const double place = on_row_edge && on_column_edge ? air.corner
                           : on_row_edge || on_column_edge ? air.border
                                                           : air.inside;
      const double coefficient = air.density * place * pattern.area[grid.index(i, j)];
      linear_[grid.index(i, j)] = coefficient;
      active_ = active_ || coefficient > 0.0;
    }
  }
}

void AirDamping::addCoefficients(const Grid& grid, const Field3& velocity, Field& out) const noexcept {
  const std::size_t size = grid.size();
  for (std::size_t n = 0; n < size; ++n) {
    const double speed = std::sqrt(velocity.x[n] * velocity.x[n] + velocity.y[n] * velocity.y[n] +
                                   velocity.z[n] * velocity.z[n]);
    out[n] += linear_[n] * dampingGrowth(air_, speed);
  }
}

}  // namespace curtain
