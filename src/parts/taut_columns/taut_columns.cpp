// SPDX-License-Identifier: BSD-3-Clause
#include "parts/taut_columns/taut_columns.h"

#include <algorithm>

#include "cloth/archive.h"

namespace curtain {

TautColumns::TautColumns(const Scene& scene, const ClothPattern& pattern)
    : scene_(scene), pattern_(pattern), held_(pattern.grid.size(), 0), before_(held_) {
  list_.reserve(pattern.grid.size());
  spans_.reserve(pattern.grid.size());
}

// pinned: by the parts before this one, by node.
void TautColumns::findSpans(const std::vector<std::uint8_t>& pinned) const noexcept {
  const Grid& grid = pattern_.grid;
  spans_.clear();
  for (int j = 0; j < grid.columns; ++j) {
    int first = -1;
    double length = 0.0;
    for (int i = 0; i < grid.rows; ++i) {
      const std::size_t n = grid.index(i, j);
      length += pattern_.warp_rest[n];
      if (pattern_.scene_pins[n] != kPinned && pinned[n] == 0) continue;
      if (first >= 0 && i > first + 1) spans_.push_back({grid.index(first, j), n, length});
      first = i;
      length = 0.0;
    }
  }
}

// Its nodes are on the line if no rod is longer than it may be: between pins as far apart as the column is long.
bool TautColumns::rodsHold(const Span& span, const Field3& position) const noexcept {
  const auto stride = static_cast<std::size_t>(pattern_.grid.stride);
  for (std::size_t n = span.first + stride; n <= span.last; n += stride) {
    const double longest = (1.0 + scene_.solver.stretch_tolerance) * pattern_.warp_rest[n];
    if (!((position.at(n) - position.at(n - stride)).norm() <= longest)) return false;
  }
  return true;
}

// Straight within the tolerance of a rod's length: by as much the solve may make them longer. True: others are held
// than before.
bool TautColumns::find(const ClothState& state) noexcept {
  if (spans_.empty() && list_.empty()) return false;
  for (std::size_t n = 0; n < held_.size(); ++n) before_[n] = isHeld(n) ? 1 : 0;
  std::fill(held_.begin(), held_.end(), std::uint8_t{0});
  const auto stride = static_cast<std::size_t>(pattern_.grid.stride);
  for (const Span& span : spans_) {
    const bool straight = isStraight(span, state.position.at(span.last) - state.position.at(span.first));
    if (!straight || !rodsHold(span, state.position)) continue;
    for (std::size_t n = span.first + stride; n < span.last; n += stride) held_[n] = 1;
  }
  list();
  return held_ != before_;
}

void TautColumns::list() noexcept {
  list_.clear();
  for (std::size_t n = 0; n < held_.size(); ++n) {
    if (held_[n] != 0) list_.push_back(n);
  }
}

void TautColumns::reset(ClothState& state) {
  std::fill(held_.begin(), held_.end(), std::uint8_t{0});
  list_.clear();
  findSpans(held_);
  find(state);
}

// Those whose pins were let go since are free.
void TautColumns::pin(std::vector<std::uint8_t>& pinned) const noexcept {
  findSpans(pinned);
  const auto stride = static_cast<std::size_t>(pattern_.grid.stride);
  for (const Span& span : spans_) {
    for (std::size_t n = span.first + stride; n < span.last; n += stride) {
      if (held_[n] != 0) pinned[n] = kHeld;
    }
  }
}

// Its nodes keep their places along the line between the pins, whose velocities are set. Pins that come nearer in the
// frame let them go.
bool TautColumns::beginFrame(const FrameBegin& begin, ClothState& state) noexcept {
  const auto stride = static_cast<std::size_t>(pattern_.grid.stride);
  bool changed = false;
  for (const Span& span : spans_) {
    const Vec3 from = state.velocity.at(span.first), to = state.velocity.at(span.last);
    const bool straight =
        isStraight(span, state.position.at(span.last) - state.position.at(span.first) + (to - from) / begin.rate);
    double along = 0.0;
    for (std::size_t n = span.first + stride; n < span.last; n += stride) {
      along += pattern_.warp_rest[n];
      if (!isHeld(n)) continue;
      if (straight) {
        state.velocity.set(n, from + along / span.length * (to - from));
      } else {
        held_[n] = 0;
        changed = true;
      }
    }
  }
  if (changed) list();
  return changed;
}

bool TautColumns::endFrame(const FrameEnd&, ClothState& state) noexcept { return find(state); }

void TautColumns::serialize(Archive& archive) {
  archive.list("taut_columns", list_, [&](std::size_t& node) { archive.node("node", node, pattern_.grid); });
}

void TautColumns::resume() {
  std::fill(held_.begin(), held_.end(), std::uint8_t{0});
  for (const std::size_t node : list_) held_[node] = 1;
}

}  // namespace curtain
