// SPDX-License-Identifier: BSD-3-Clause
//
// Columns that fall asleep and wake while others move. Substeps swap buffers, so a block of columns that is left out
// needs its positions and multipliers in both. Multipliers scale with the substep (h * kick): they are rescaled when
// the block wakes.
#include <cmath>

#include "cloth/archive.h"
#include "solver/constraints.h"

namespace curtain {

void Constraints::hold(const std::vector<std::uint8_t>& skipped_before, const ClothState& state,
                       NodeInertia::Tensions& tensions) noexcept {
  const Grid& grid = pattern_.grid;
  freeWeft(pattern_, inertia_.masses(), free_per_square_);
  // Nothing is measured outside the span of what moves.
  std::fill(violation_.begin(), violation_.end(), 0.0);
  std::fill(active_.begin(), active_.end(), 0.0);
  net_.reset();
  tensions.heaviest = 0.0;
  bool any_moves = false;
  for (int block = 0; block < warpBlockCount(grid); ++block) {
    const bool was_skipped = skipped_before[static_cast<std::size_t>(block)] != 0;
    const bool padding = block * kLane >= grid.columns;
    if (held_.skips(block) && (padding || !was_skipped)) freeze(block, state, tensions);
    if (!held_.skips(block) && was_skipped) thaw(block, tensions);
    if (!held_.skips(block)) tensions.heaviest = std::max(tensions.heaviest, heaviestOf(block, tensions.load));
    any_moves = any_moves || !held_.skips(block);
  }
  // Cloth with cords sleeps as a whole: now it wakes, and thaw() has counted its rods and strings alone.
  if (any_moves && cords_.any()) tensions.heaviest = std::max(tensions.heaviest, cords_.addLoads(tensions.load));
}

void Constraints::takePins() noexcept {
  freeWeft(pattern_, inertia_.masses(), free_per_square_);
  net_.reset();
}

void Constraints::slackenBetweenPins() noexcept {
  const Field& w = inertia_.masses();
  forEachLink(pattern_, [&](std::size_t n, std::size_t other, double, bool rod) {
    if (w[n] + w[other] == 0.0) (rod ? last_warp_ : last_weft_)[n] = 0.0;
  });
}

void Constraints::freeze(int block, const ClothState& state, NodeInertia::Tensions& tensions) noexcept {
  const Grid& grid = pattern_.grid;
  const std::size_t first = static_cast<std::size_t>(block) * kLane;
  const auto copy = [first](const Field& from, Field& to, std::size_t row) {
    std::copy_n(from.data() + row + first, kLane, to.data() + row + first);
  };
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t row = grid.row(i);
    copy(state.position.x, next.x, row);
    copy(state.position.y, next.y, row);
    copy(state.position.z, next.z, row);
    copy(last_warp_, warp_.multiplier, row);
    std::fill_n(tensions.load.data() + row + first, kLane, 0.0);
  }
  const auto at = static_cast<std::size_t>(block);
  frozen_scale_[at] = tensions.scale;
  block_progress_[at] = RodsProgress();
  block_motion_[at] = WarpMotion();
}

void Constraints::thaw(int block, NodeInertia::Tensions& tensions) noexcept {
  const Grid& grid = pattern_.grid;
  const auto stride = static_cast<std::size_t>(grid.stride);
  const double before = frozen_scale_[static_cast<std::size_t>(block)];
  const double ratio = before != 0.0 ? tensions.scale / before : 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    for (std::size_t n = grid.row(i) + static_cast<std::size_t>(block) * kLane, k = 0; k < kLane; ++k, ++n)
      last_warp_[n] *= ratio;
  }
  for (int i = 0; i < grid.rows; ++i) {
    const int end = std::min((block + 1) * kLane, grid.columns);
    for (int j = block * kLane; j < end; ++j) {
      const std::size_t n = grid.index(i, j);
      const std::size_t right = grid.index(i, j + 1 < grid.columns ? j + 1 : 0);
      const double strings = last_weft_[n] + (j + 1 < grid.columns || grid.closed ? last_weft_[right] : 0.0);
      tensions.load[n] = std::abs(last_warp_[n]) + std::abs(last_warp_[n + stride]) + strings;
    }
  }
}

// Largest load over mass of a block's nodes.
double Constraints::heaviestOf(int block, const Field& load) const noexcept {
  const Grid& grid = pattern_.grid;
  double worst = 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    for (std::size_t n = grid.row(i) + static_cast<std::size_t>(block) * kLane, k = 0; k < kLane; ++k, ++n) {
      worst = std::max(worst, load[n] * pattern_.inverse_mass[n]);
    }
  }
  return worst;
}

// Restores what hold() and reset() guarantee: both buffers of skipped blocks agree, strings have no multipliers but
// those of the last substep, nothing is measured where nothing moves.
void Constraints::resume(const ClothState& state) noexcept {
  freeWeft(pattern_, inertia_.masses(), free_per_square_);
  next = state.position;
  warp_.multiplier = last_warp_;
  for (Field* field : {&weft_.multiplier, &violation_, &active_, &change_})
    std::fill(field->begin(), field->end(), 0.0);
  std::fill(block_progress_.begin(), block_progress_.end(), RodsProgress());
  std::fill(block_motion_.begin(), block_motion_.end(), WarpMotion());
  cords_.resume(state);
  scratch_.assign(pattern_.grid);
  net_.reset();
}

}  // namespace curtain
