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
      if (pattern_.scene_pins[n] == kFree && pinned[n] == kFree) continue;
      if (first >= 0 && i > first + 1) spans_.push_back({grid.index(first, j), n, length});
      first = i;
      length = 0.0;
    }
  }
}

// Where its first node can go: a carrier along its rail.
Vec3 TautColumns::freedomOf(const Span& span, const ClothState& state) const noexcept {
  if (!hangsFromCarrier(span)) return Vec3::Zero();
  const auto at = std::lower_bound(pattern_.guided.begin(), pattern_.guided.end(), span.first);
  const auto guided = static_cast<std::size_t>(at - pattern_.guided.begin());
  std::size_t k = guided;
  auto rail = pattern_.rails.begin();
  for (; k >= rail->size(); ++rail) k -= rail->size();
  return rail->freedomOf(k, state.place[guided]);
}

// Its ends are as far apart as it is long, after one has moved from the other, and wherever the first can go.
bool TautColumns::isStraight(const Span& span, const ClothState& state, const Vec3& moved) const noexcept {
  const Vec3 apart = state.position.at(span.last) - state.position.at(span.first) + moved;
  const Vec3 along = freedomOf(span, state);
  return (apart - apart.dot(along) * along).norm() >= (1.0 - scene_.solver.stretch_tolerance) * span.length;
}

// Calls visit(node) for the nodes that a straight one holds.
template <typename Visit>
void TautColumns::forEachHeld(const Span& span, const Visit& visit) const {
  const auto stride = static_cast<std::size_t>(pattern_.grid.stride);
  for (std::size_t n = span.first + (hangsFromCarrier(span) ? 0 : stride); n < span.last; n += stride) visit(n);
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
  for (const Span& span : spans_) {
    if (!isStraight(span, state, Vec3::Zero()) || !rodsHold(span, state.position)) continue;
    forEachHeld(span, [&](std::size_t n) { held_[n] = 1; });
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
  for (const Span& span : spans_) {
    forEachHeld(span, [&](std::size_t n) {
      if (held_[n] != 0) pinned[n] = kHeld;
    });
  }
}

// Its nodes keep their places along the line between the pins, whose velocities are set. Pins that come nearer in the
// frame let them go, and below a carrier any that moves: the carrier may follow it.
bool TautColumns::beginFrame(const FrameBegin& begin, ClothState& state) noexcept {
  bool changed = false;
  for (const Span& span : spans_) {
    const bool carried = hangsFromCarrier(span);
    const Vec3 from = carried ? Vec3::Zero() : Vec3(state.velocity.at(span.first)), to = state.velocity.at(span.last);
    const bool straight = carried ? to.isZero(0.0) : isStraight(span, state, (to - from) / begin.rate);
    double along = 0.0;
    forEachHeld(span, [&](std::size_t n) {
      if (n != span.first) along += pattern_.warp_rest[n];
      if (!isHeld(n)) return;
      if (straight) {
        state.velocity.set(n, from + along / span.length * (to - from));
      } else {
        held_[n] = 0;
        changed = true;
      }
    });
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
