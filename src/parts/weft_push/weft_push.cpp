// SPDX-License-Identifier: BSD-3-Clause
#include "parts/weft_push/weft_push.h"

#include <algorithm>
#include <cmath>

#include "cloth/wide.h"
#include "scene/pi.h"

namespace curtain {
namespace {

constexpr double kNoLength = 1e-300;  // [m]; a link that has none has no direction either

// Calls visit(node on the right, node on the left) for all weft links.
template <typename Visit>
void forEachWeft(const Grid& grid, const Visit& visit) {
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
      if (grid.hasLink(i, j)) visit(grid.index(i, j), grid.index(i, j > 0 ? j - 1 : grid.columns - 1));
    }
  }
}

}  // namespace

WeftPush::WeftPush(const Layers& layers, const ClothPattern& pattern) : pattern_(pattern) {
  if (!layers.anyFabric([](const Fabric& fabric) { return fabric.push() > 0.0; })) return;
  const Grid& grid = pattern.grid;
  load_.assign(grid.size(), 0.0);
  const auto stride = static_cast<std::size_t>(grid.stride);
  const auto rigidityAt = [&](std::size_t n) {
    return layers.fabricAt(static_cast<int>(n / stride), static_cast<int>(n % stride)).push();
  };
  forEachWeft(grid, [&](std::size_t n, std::size_t left) {
    const double rigidity = 0.5 * (rigidityAt(n) + rigidityAt(left));
    // Half the cloth to the next row belongs to this.
    const double above = n >= stride ? pattern.cell[n - stride] * pattern.warp_rest[n] : 0.0;
    const double below = n + stride < grid.row(grid.rows) ? pattern.cell[n] * pattern.warp_rest[n + stride] : 0.0;
    const double rest = pattern.weft_rest[n];
    load_[n] = kPi * kPi * rigidity / (rest * rest) * 0.5 * (above + below);
  });
  assign(grid.size());
  push_.assign(stride + 1, 0.0);
}

CURTAIN_WIDE void WeftPush::addRow(const Field3& position, int row, Field3& sum) noexcept {
  const Grid& grid = pattern_.grid;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const std::size_t first = grid.row(row);
  const ConstFieldView x(position, first);
  const FieldView push(push_, 0), total(sum, first);
  const double* const load = load_.data() + first;
#pragma omp simd
  for (std::size_t j = 1; j < columns; ++j) {
    const double ex = x.x[j] - x.x[j - 1], ey = x.y[j] - x.y[j - 1], ez = x.z[j] - x.z[j - 1];
    const double length = std::sqrt(ex * ex + ey * ey + ez * ez);
    const double share = load[j] / (length > kNoLength ? length : kNoLength);
    push.x[j] = share * ex;
    push.y[j] = share * ey;
    push.z[j] = share * ez;
  }
  if (grid.closed) {
    const Vec3 seam = position.at(first) - position.at(first + columns - 1);
    push_.set(0, load[0] / std::max(seam.norm(), kNoLength) * seam);
  }
  const std::size_t last = columns - 1;
  const bool closed = grid.closed;
  const auto add = [last, closed](const double* of, double* to) {
#pragma omp simd
    for (std::size_t j = 0; j < last; ++j) to[j] += of[j] - of[j + 1];
    to[last] += closed ? of[last] - of[0] : of[last];
  };
  add(push.x, total.x);
  add(push.y, total.y);
  add(push.z, total.z);
}

void WeftPush::addOwn(const Field3& position, Field3& sum) noexcept {
  for (int i = 0; i < pattern_.grid.rows; ++i) addRow(position, i, sum);
}

// Of its links at their lengths it has none.
double WeftPush::energyAt(const Field3& position) const noexcept {
  double sum = 0.0;
  forEachWeft(pattern_.grid, [&](std::size_t n, std::size_t left) {
    sum += load_[n] * (pattern_.weft_rest[n] - (position.at(n) - position.at(left)).norm());
  });
  return sum;
}

bool WeftPush::explain(const ClothState&, double, Plan& plan) const {
  plan.push_back({"weft push", any(),
                  any() ? "wefts push with the Euler load of their links" : "cloth.shear or cloth.bending_weft is 0"});
  return false;
}

}  // namespace curtain
