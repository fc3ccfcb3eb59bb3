// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/swept_bounds.h"

#include "cloth/wide.h"

namespace curtain {

CURTAIN_WIDE Range rangeOf(const double* a, const double* b, std::size_t count) noexcept {
  double low = a[0], high = a[0];
#pragma omp simd reduction(min : low) reduction(max : high)
  for (std::size_t n = 0; n < count; ++n) {
    const double least = a[n] < b[n] ? a[n] : b[n];
    const double most = a[n] < b[n] ? b[n] : a[n];
    low = low < least ? low : least;
    high = high > most ? high : most;
  }
  return {low, high};
}

Eigen::AlignedBox3d boxAround(const Grid& grid, const Field3& start, const Field3& end) noexcept {
  Eigen::AlignedBox3d box;
  const auto columns = static_cast<std::size_t>(grid.columns);
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t row = grid.row(i);
    const Range x = rangeOf(&start.x[row], &end.x[row], columns);
    const Range y = rangeOf(&start.y[row], &end.y[row], columns);
    const Range z = rangeOf(&start.z[row], &end.z[row], columns);
    box.extend(Vec3(x.low, y.low, z.low));
    box.extend(Vec3(x.high, y.high, z.high));
  }
  return box;
}

}  // namespace curtain
