// SPDX-License-Identifier: BSD-3-Clause
#include "contact/cloth_reach.h"

#include <algorithm>
#include <cmath>

#include "cloth/wide.h"

namespace curtain {
namespace {

struct Range {
  double low, high;
};

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

CURTAIN_WIDE double largestMove(const Field3& a, const Field3& b, std::size_t first, std::size_t count) noexcept {
  const double *const ax = &a.x[first], *const ay = &a.y[first], *const az = &a.z[first];
  const double *const bx = &b.x[first], *const by = &b.y[first], *const bz = &b.z[first];
  double worst = 0.0;
#pragma omp simd reduction(max : worst)
  for (std::size_t n = 0; n < count; ++n) {
    const double x = bx[n] - ax[n], y = by[n] - ay[n], z = bz[n] - az[n];
    const double square = x * x + y * y + z * z;
    worst = worst > square ? worst : square;
  }
  return worst;
}

}  // namespace

ClothMotion motionOfCloth(const Grid& grid, const Field3& start, const Field3& predicted) noexcept {
  ClothMotion motion;
  const auto columns = static_cast<std::size_t>(grid.columns);
  double square = 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t row = grid.row(i);
    const Range x = rangeOf(&start.x[row], &predicted.x[row], columns);
    const Range y = rangeOf(&start.y[row], &predicted.y[row], columns);
    const Range z = rangeOf(&start.z[row], &predicted.z[row], columns);
    motion.box.extend(Vec3(x.low, y.low, z.low));
    motion.box.extend(Vec3(x.high, y.high, z.high));
    square = std::max(square, largestMove(start, predicted, row, columns));
  }
  motion.move = std::sqrt(square);
  return motion;
}

}  // namespace curtain
