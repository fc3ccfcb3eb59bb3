// SPDX-License-Identifier: BSD-3-Clause
#include "bench/rivals/grid_state.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curtain_bench {

GridState::GridState(const ClothStart& start)
    : gravity(start.gravity.begin(), start.gravity.end()),
      damping(start.damping),
      frame_seconds(start.frame_seconds),
      rows_(start.rows),
      columns_(start.columns) {
  const std::size_t nodes = start.count();
  position.assign(nodes, 0.0);
  velocity.assign(nodes, 0.0);
  mass.assign(nodes, 0.0);
  inverse_mass.assign(nodes, 0.0);
  free.assign(nodes, 0.0);
  min_free_mass = std::numeric_limits<double>::infinity();
  for (int i = 0; i < rows_; ++i) {
    for (int j = 0; j < columns_; ++j) {
      const auto from = static_cast<std::size_t>(i * columns_ + j);
      const std::size_t to = index(i, j);
      position.x[to] = start.positions.x[from];
      position.y[to] = start.positions.y[from];
      position.z[to] = start.positions.z[from];
      mass[to] = start.mass[from];
      if (start.pinned[from] != 0) continue;
      inverse_mass[to] = 1.0 / mass[to];
      free[to] = 1.0;
      min_free_mass = std::min(min_free_mass, mass[to]);
    }
  }
  const auto add = [this](std::size_t a, std::size_t b, std::size_t count, double rest, bool two_sided) {
    if (count == 0) return;
    batches.push_back({a, b, count, link_count, rest, two_sided});
    link_count += count;
  };
  const auto columns = static_cast<std::size_t>(columns_);
  for (int i = 1; i < rows_; ++i) add(index(i - 1, 0), index(i, 0), columns, start.warp_rest, true);
  const std::size_t evens = (columns + 1) / 2;
  for (int i = 0; i < rows_; ++i) {
    const std::size_t row = index(i, 0);
    add(row, row + evens, columns / 2, start.weft_rest, false);
    add(row + evens, row + 1, evens - 1, start.weft_rest, false);
  }
}

std::size_t GridState::index(int row, int column) const {
  const int evens = (columns_ + 1) / 2;
  const int place = column % 2 == 0 ? column / 2 : evens + column / 2;
  return static_cast<std::size_t>(row * columns_ + place);
}

void GridState::copyOut(const Triple& from, Points& out) const {
  out.resize(count());
  for (int i = 0; i < rows_; ++i) {
    for (int j = 0; j < columns_; ++j) {
      const auto to = static_cast<std::size_t>(i * columns_ + j);
      out.x[to] = from.x[index(i, j)];
      out.y[to] = from.y[index(i, j)];
      out.z[to] = from.z[index(i, j)];
    }
  }
}

double springEnergy(const GridState& state, double stiffness) {
  double energy = 0.0;
  for (const LinkBatch& batch : state.batches) {
    for (std::size_t k = 0; k < batch.count; ++k) {
      const std::size_t a = batch.a + k, b = batch.b + k;
      const double length = std::sqrt(std::pow(state.position.x[b] - state.position.x[a], 2) +
                                      std::pow(state.position.y[b] - state.position.y[a], 2) +
                                      std::pow(state.position.z[b] - state.position.z[a], 2));
      const double stretch = batch.two_sided ? length - batch.rest : std::max(0.0, length - batch.rest);
      energy += 0.5 * stiffness * stretch * stretch;
    }
  }
  return energy;
}

}  // namespace curtain_bench
