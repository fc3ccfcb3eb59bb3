// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/link_ways.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curtain {
namespace {

// Samples along warp and weft: few enough to cost little beside a pass over 1000 nodes.
constexpr int kSampleRows = 8, kSampleColumns = 4;

Eigen::AlignedBox3d grown(const Vec3& low, const Vec3& high, double margin) noexcept {
  return {Vec3(low.array() - margin), Vec3(high.array() + margin)};
}

// Distance of every node along the links from the nearest of `nodes` [m]; infinite: not connected. Links between two
// pins do not count, since pins can be moved apart. Bellman-Ford in both orders of the nodes, which takes few passes.
std::vector<double> awayAlongLinks(const ClothPattern& pattern, const std::vector<std::size_t>& nodes) {
  const Grid& grid = pattern.grid;
  std::vector<double> away(grid.size(), std::numeric_limits<double>::infinity());
  for (const std::size_t n : nodes) away[n] = 0.0;
  const auto relax = [&](std::size_t n, std::size_t from, double length) {
    const bool between_pins = pattern.inverse_mass[n] == 0.0 && pattern.inverse_mass[from] == 0.0;
    if (between_pins || !(away[from] + length < away[n])) return false;
    away[n] = away[from] + length;
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
        if (!grid.hasLink(i, j)) continue;
        changed |= relax(n, before, pattern.weft_rest[n]);
        changed |= relax(before, n, pattern.weft_rest[n]);
      }
    }
  }
  return away;
}

}  // namespace

SampledBounds::SampledBounds(const ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  const int rows = std::min(grid.rows, kSampleRows), columns = std::min(grid.columns, kSampleColumns);
  for (int i = 0; i < rows; ++i) {
    // In the middle of equal shares of the grid.
    const int row = (2 * i + 1) * grid.rows / (2 * rows);
    for (int j = 0; j < columns; ++j) samples_.push_back(grid.index(row, (2 * j + 1) * grid.columns / (2 * columns)));
  }
  const std::vector<double> away = awayAlongLinks(pattern, samples_);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      all_.push_back(n);
      if (std::isfinite(away[n]))
        margin_ = std::max(margin_, kOverlong * away[n]);
      else
        samples_.push_back(n);  // connected only through pins
    }
  }
}

Eigen::AlignedBox3d SampledBounds::around(const Field3& position) const noexcept {
  Vec3 low = position.at(nodes().front()), high = low;
  for (const std::size_t n : nodes()) {
    const Vec3 at = position.at(n);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  return grown(low, high, margin());
}

double SampledBounds::farthest(const Field3& start, const Field3& end) const noexcept {
  double squared = 0.0;
  for (const std::size_t n : nodes()) squared = std::max(squared, (end.at(n) - start.at(n)).squaredNorm());
  return std::sqrt(squared);
}

}  // namespace curtain
