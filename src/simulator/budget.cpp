// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/budget.h"

#include <algorithm>

namespace curtain {
namespace {

// Share of the budget kept free: the deadline is checked between sweeps only.
constexpr double kSpare = 0.1;
// Stalled frames in a row after which a substep may take what it needs.
constexpr int kMaxStalledFrames = 4;
// A substep is started only if this many times their mean computing time is left.
constexpr double kTimeMargin = 1.4;
constexpr int kManySubsteps = 1 << 20;

double secondsBetween(Budget::Clock::time_point a, Budget::Clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

Budget::Clock::time_point later(Budget::Clock::time_point from, double seconds) {
  return from + std::chrono::duration_cast<Budget::Clock::duration>(std::chrono::duration<double>(seconds));
}

}  // namespace

void Budget::forget() noexcept {
  substep_ = reference_ = tail_ = frame_ = 0.0;
  stalled_ = 0;
}

void Budget::beginFrame(Clock::time_point begin) noexcept {
  begin_ = begin;
  moved_ = false;
  end_ = later(begin, std::max(0.0, (1.0 - kSpare) * seconds_ - tail_));
}

bool Budget::affordsCompanion() const noexcept { return !any() || frame_ + reference_ < (1.0 - kSpare) * seconds_; }

bool Budget::mustMove() const noexcept { return stalled_ >= kMaxStalledFrames && !moved_; }

int Budget::affordable(Clock::time_point now) const noexcept {
  if (!any() || substep_ <= 0.0) return kManySubsteps;
  const double count = secondsBetween(now, end_) / substep_;
  return count < 1.0 ? 1 : static_cast<int>(std::min(count, static_cast<double>(kManySubsteps)));
}

Budget::Clock::time_point Budget::substepEnds() const noexcept {
  return !any() || mustMove() ? Clock::time_point::max() : end_;
}

bool Budget::over(Clock::time_point now) const noexcept {
  if (!any() || mustMove()) return false;
  return moved_ ? secondsBetween(now, end_) < kTimeMargin * substep_ : now >= end_;
}

void Budget::endFrame(double share, Clock::time_point tail_begin, Clock::time_point end) noexcept {
  tail_ = follow(tail_, secondsBetween(tail_begin, end));
  frame_ = follow(frame_, secondsBetween(begin_, end));
  stalled_ = share > 0.0 ? 0 : stalled_ + 1;
}

}  // namespace curtain
