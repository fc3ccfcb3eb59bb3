// SPDX-License-Identifier: BSD-3-Clause
//
// Columns that fall asleep and wake while others move. A block of columns that is left out must have its positions and
// multipliers in both of the buffers that substeps swap; what the multipliers are worth depends on the substep's length.
#include <algorithm>
#include <cmath>

#include "solver/exact_solver.h"

namespace curtain {

void ExactSolver::hold(const ColumnSet& columns, ClothState& state) noexcept {
  const Grid& grid = pattern_.grid;
  NodeInertia::Tensions& tensions = inertia_.tensions();
  const double per_scale = tensions.scale != 0.0 ? 1.0 / tensions.scale : 0.0;
  for (int j = 0; j < grid.columns; ++j) {
    if (!columns.has(j) || held_.has(j)) continue;
    for (int i = 0; i < grid.rows; ++i) state.velocity.set(grid.index(i, j), Vec3::Zero());
  }
  std::vector<std::uint8_t>& skipped = skipped_before_;
  for (int block = 0; block < warpBlockCount(grid); ++block) {
    skipped[static_cast<std::size_t>(block)] = held_.skips(block) ? 1 : 0;
  }
  held_.set(columns, state.position, last_weft_, per_scale);
  inertia_.hold(columns);
  freeWeft(pattern_, inertia_.masses(), free_per_square_);
  // Outside the span of what moves nothing is measured any more.
  std::fill(violation_.begin(), violation_.end(), 0.0);
  std::fill(active_.begin(), active_.end(), 0.0);
  net_.reset();
  tensions.heaviest = 0.0;
  for (int block = 0; block < warpBlockCount(grid); ++block) {
    const bool was_skipped = skipped[static_cast<std::size_t>(block)] != 0;
    const bool padding = block * kLane >= grid.columns;
    if (held_.skips(block) && (padding || !was_skipped)) layDown(block, state);
    if (!held_.skips(block) && was_skipped) takeUp(block);
    if (!held_.skips(block)) tensions.heaviest = std::max(tensions.heaviest, heaviestOf(block));
  }
}

void ExactSolver::layDown(int block, ClothState& state) noexcept {
  const Grid& grid = pattern_.grid;
  const std::size_t first = static_cast<std::size_t>(block) * kLane;
  const auto copy = [first](const Field& from, Field& to, std::size_t row) {
    std::copy_n(from.data() + row + first, kLane, to.data() + row + first);
  };
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t row = grid.row(i);
    copy(state.position.x, next_.x, row);
    copy(state.position.y, next_.y, row);
    copy(state.position.z, next_.z, row);
    copy(last_warp_, warp_.multiplier, row);
    std::fill_n(inertia_.tensions().load.data() + row + first, kLane, 0.0);
  }
  const auto at = static_cast<std::size_t>(block);
  laid_down_[at] = inertia_.tensions().scale;
  block_begun_[at] = LineOutcome();
  block_progress_[at] = WarpProgress();
  block_motion_[at] = WarpMotion();
}

void ExactSolver::takeUp(int block) noexcept {
  const Grid& grid = pattern_.grid;
  const auto stride = static_cast<std::size_t>(grid.stride);
  const double before = laid_down_[static_cast<std::size_t>(block)];
  const double ratio = before != 0.0 ? inertia_.tensions().scale / before : 0.0;
  Field& load = inertia_.tensions().load;
  for (int i = 0; i < grid.rows; ++i) {
    for (std::size_t n = grid.row(i) + static_cast<std::size_t>(block) * kLane, k = 0; k < kLane; ++k, ++n) last_warp_[n] *= ratio;
  }
  for (int i = 0; i < grid.rows; ++i) {
    const int end = std::min((block + 1) * kLane, grid.columns);
    for (int j = block * kLane; j < end; ++j) {
      const std::size_t n = grid.index(i, j);
      const std::size_t right = grid.index(i, j + 1 < grid.columns ? j + 1 : 0);
      const double strings = last_weft_[n] + (j + 1 < grid.columns || grid.closed ? last_weft_[right] : 0.0);
      load[n] = std::abs(last_warp_[n]) + std::abs(last_warp_[n + stride]) + strings;
    }
  }
}

// Largest load of a block's nodes over their mass.
double ExactSolver::heaviestOf(int block) const noexcept {
  const Grid& grid = pattern_.grid;
  double worst = 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    for (std::size_t n = grid.row(i) + static_cast<std::size_t>(block) * kLane, k = 0; k < kLane; ++k, ++n) {
      worst = std::max(worst, inertia_.tensions().load[n] * pattern_.inverse_mass[n]);
    }
  }
  return worst;
}

}  // namespace curtain
