// SPDX-License-Identifier: BSD-3-Clause
#include "parts/air/air_damping.h"

#include <algorithm>
#include <cmath>

#include "cloth/wide.h"

namespace curtain {

AirDamping::AirDamping(const AirParams& air, const ClothPattern& pattern) : air_(air) {
  const Grid& grid = pattern.grid;
  linear_.assign(grid.size(), 0.0);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const bool on_row_edge = i == 0 || i + 1 == grid.rows;
      const bool on_column_edge = !grid.hasLink(i, j) || !grid.hasLink(i, j + 1 < grid.columns ? j + 1 : 0);
      const double place = on_row_edge && on_column_edge   ? air.corner
                           : on_row_edge || on_column_edge ? air.border
                                                           : air.inside;
      const double coefficient = air.density * place * pattern.area[grid.index(i, j)];
      linear_[grid.index(i, j)] = coefficient;
      active_ = active_ || coefficient > 0.0;
    }
  }
}

double AirDamping::strongestPerMass(const ClothPattern& pattern) const noexcept {
  double most = 0.0;
  for (std::size_t n = 0; n < linear_.size(); ++n) most = std::max(most, linear_[n] * pattern.inverse_mass[n]);
  return most;
}

CURTAIN_WIDE void AirDamping::addCoefficients(const Grid& grid, const Field3& velocity, Field& out) const noexcept {
  const std::size_t size = grid.size();
  const ConstFieldView v(velocity, 0);
  const double* const linear = linear_.data();
  double* const sum = out.data();
  const AirParams air = air_;
#pragma omp simd
  for (std::size_t n = 0; n < size; ++n) {
    const double speed = std::sqrt(v.x[n] * v.x[n] + v.y[n] * v.y[n] + v.z[n] * v.z[n]);
    sum[n] += linear[n] * dampingGrowth(air, speed);
  }
}

}  // namespace curtain
