// SPDX-License-Identifier: BSD-3-Clause
#include "step/net_rows.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace curtain {
namespace {

constexpr std::size_t kRowsAtOnce = 256;  // of a task for the workers: some ten microseconds

}  // namespace

void NetRows::scale(const Frame& frame, const Row& row, Packed& packed) noexcept {
  packed.dx = static_cast<float>(row.direction.x());
  packed.dy = static_cast<float>(row.direction.y());
  packed.dz = static_cast<float>(row.direction.z());
  packed.on = row.active ? 1.0F : 0.0F;
  packed.damping = std::max(frame.damping, static_cast<float>(row.min_damping));
  packed.compliance = static_cast<float>(row.compliance / frame.inertia_scale);
  packed.per_diagonal = 1.0F / (packed.diagonal * (1.0F + packed.damping) + packed.compliance);
  packed.residual = static_cast<float>(row.violation / frame.violation_scale);
  packed.least = static_cast<float>(row.least * (frame.inertia_scale / frame.violation_scale));
  aligned_ += packed.aligned();
}

void NetRows::turn(float beta, NetNodes push) noexcept {
  for (Packed& row : rows_) {
    row.pull = row.on * row.residual * row.per_diagonal + beta * row.pull;
    row.push(row.pull, push);
  }
}

double NetRows::product(NetNodes move) noexcept {
  terms_.resize(rows_.size());
  workers_.runChunks(rows_.size(), kRowsAtOnce, [&](std::size_t first, std::size_t end) {
    for (std::size_t r = first; r < end; ++r) {
      Packed& row = rows_[r];
      float along = (row.damping * row.diagonal + row.compliance) * row.pull;
      for (int k = 0; k < row.nodes; ++k) {
        const auto at = static_cast<std::size_t>(k);
        const std::uint32_t node = row.node[at];
        along += row.weight[at] * (row.dx * move.x[node] + row.dy * move.y[node] + row.dz * move.z[node]);
      }
      row.product = along;
      terms_[r] = static_cast<double>(along * row.pull);
    }
  });
  return std::accumulate(terms_.begin(), terms_.end(), 0.0);
}

double NetRows::advance(float alpha) noexcept {
  float largest = 0.0F;
  aligned_ = 0.0;
  for (Packed& row : rows_) {
    row.solution += alpha * row.pull;
    row.residual -= alpha * row.product;
    largest = std::max(largest, row.on * std::abs(row.residual));
    aligned_ += row.aligned();
  }
  return static_cast<double>(largest);
}

int NetRows::countChanges(float goal) const noexcept {
  return static_cast<int>(std::count_if(rows_.begin(), rows_.end(), [goal](const Packed& row) {
    return row.on > 0.0F ? row.solution < row.least : row.residual > goal;
  }));
}

int NetRows::changeSet(float goal, NetNodes push) noexcept {
  int leave = 0;
  aligned_ = 0.0;
  for (Packed& row : rows_) {
    row.pull = 0.0F;
    if (row.on > 0.0F && row.solution < row.least) {
      row.pull = row.least - row.solution;
      row.on = 0.0F;
      ++leave;
      row.push(row.pull, push);
    } else if (!(row.on > 0.0F) && row.residual > goal) {
      row.on = 1.0F;
    }
    aligned_ += row.aligned();
  }
  return leave;
}

void NetRows::conclude(NetNodes push) noexcept {
  for (Packed& row : rows_) {
    row.solution = row.bounded();
    row.push(row.solution, push);
  }
}

void NetRows::unload(double scale, Rows& rows) const noexcept {
  for (const Packed& row : rows_) {
    const bool within = row.bounded() > row.least;
    rows[row.index].change = within ? scale * static_cast<double>(row.solution) : rows[row.index].least;
  }
}

}  // namespace curtain
