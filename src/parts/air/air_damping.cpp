// SPDX-License-Identifier: BSD-3-Clause
#include "parts/air/air_damping.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "cloth/wide.h"

namespace curtain {
namespace {

// c_r of Eq. (4).
template <typename Air>
double atPlace(const Air& air, bool on_row_edge, bool on_column_edge) {
  if (on_row_edge && on_column_edge) return air.corner;
  return on_row_edge || on_column_edge ? air.border : air.inside;
}

}  // namespace

AirDamping::AirDamping(const AirParams& air, const Layers& layers, const ClothPattern& pattern)
    : air_(air), layers_(layers), pattern_(pattern) {
  linear_.assign(pattern.grid.size(), 0.0);
  resume();
}

void AirDamping::resume() {
  const Grid& grid = pattern_.grid;
  active_ = false;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const bool on_row_edge = i == 0 || i + 1 == grid.rows;
      const bool on_column_edge = !grid.hasLink(i, j) || !grid.hasLink(i, j + 1 < grid.columns ? j + 1 : 0);
      const LayerAirParams* const own = layers_.at(j).air;
      const double place =
          own != nullptr ? atPlace(*own, on_row_edge, on_column_edge) : atPlace(air_, on_row_edge, on_column_edge);
      const double coefficient = air_.density * place * pattern_.area[grid.index(i, j)];
      linear_[grid.index(i, j)] = coefficient;
      active_ = active_ || coefficient > 0.0;
    }
  }
}

double AirDamping::dampingPerMass(double&) const noexcept {
  double most = 0.0;
  for (std::size_t n = 0; n < linear_.size(); ++n) most = std::max(most, linear_[n] * pattern_.inverse_mass[n]);
  return most;
}

bool AirDamping::explain(const ClothState&, double, Plan& plan) const {
  double still = 0.0;
  std::ostringstream most;
  most << dampingPerMass(still);
  plan.push_back({"air damping", active_, active_ ? "by " + most.str() + " 1/s at most" : "all coefficients are 0"});
  return false;
}

CURTAIN_WIDE void AirDamping::addCoefficients(const Field3& velocity, Field& out) const noexcept {
  const std::size_t size = pattern_.grid.size();
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
