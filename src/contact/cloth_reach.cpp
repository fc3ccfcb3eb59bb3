// SPDX-License-Identifier: BSD-3-Clause
#include "contact/cloth_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cloth/wide.h"

namespace curtain {
namespace {

// Links may be this much longer while something goes wrong.
constexpr double kOverlong = 1.1;

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

Eigen::AlignedBox3d reachOfCloth(const ClothPattern& pattern, const Field3& position) {
  const Grid& grid = pattern.grid;
  std::vector<double> away(grid.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> pin(grid.size(), 0);
  bool any = false;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      if (pattern.inverse_mass[n] > 0.0) continue;
      away[n] = 0.0;
      pin[n] = n;
      any = true;
    }
  }
  if (!any) {
    const Vec3 everywhere = Vec3::Constant(std::numeric_limits<double>::infinity());
    return {Vec3(-everywhere), everywhere};
  }
  // Shortest ways along the links (Bellman and Ford), in both orders of the nodes.
  const auto relax = [&](std::size_t n, std::size_t from, double length) {
    if (!(away[from] + length < away[n])) return false;
    away[n] = away[from] + length;
    pin[n] = pin[from];
    return true;
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (int pass = 0; pass < 2; ++pass) {
      for (int k = 0; k < grid.rows * grid.columns; ++k) {
        const int at = pass == 0 ? k : grid.rows * grid.columns - 1 - k;
        const int i = at / grid.columns, j = at % grid.columns;
        const std::size_t n = grid.index(i, j);
        const std::size_t before = grid.index(i, j > 0 ? j - 1 : grid.columns - 1);
        if (i > 0) changed |= relax(n, grid.index(i - 1, j), pattern.warp_rest[n]);
        if (i > 0) changed |= relax(grid.index(i - 1, j), n, pattern.warp_rest[n]);
        if (j == 0 && !grid.closed) continue;
        changed |= relax(n, before, pattern.weft_rest[n]);
        changed |= relax(before, n, pattern.weft_rest[n]);
      }
    }
  }
  Eigen::AlignedBox3d box;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      box.extend(Vec3(position.at(pin[n]) - Vec3::Constant(kOverlong * away[n])));
      box.extend(Vec3(position.at(pin[n]) + Vec3::Constant(kOverlong * away[n])));
    }
  }
  return box;
}

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
