// SPDX-License-Identifier: BSD-3-Clause
#include "parts/taut_columns/taut_columns.h"

#include <algorithm>

#include "cloth/archive.h"

namespace curtain {

TautColumns::TautColumns(const Scene& scene, const ClothPattern& pattern)
    : scene_(scene), pattern_(pattern), held_(pattern.grid.size(), 0), others_(pattern.grid.size(), 0) {
  list_.reserve(pattern.grid.size());
}

bool TautColumns::isPin(std::size_t node) const noexcept {
  return pattern_.scene_pins[node] == kPinned || others_[node] != 0;
}

// Calls act(first row, last row, column) for the rods between two pins that follow each other in a column, where nodes
// are in between.
template <typename Act>
void TautColumns::forEachSpan(const Act& act) const {
  for (int j = 0; j < pattern_.grid.columns; ++j) {
    int first = -1;
    for (int i = 0; i < pattern_.grid.rows; ++i) {
      if (!isPin(pattern_.grid.index(i, j))) continue;
      if (first >= 0 && i > first + 1) act(first, i, j);
      first = i;
    }
  }
}

// Within the tolerance of a rod's length: by as much the solve may make them longer.
bool TautColumns::isStraight(const Field3& position, int first, int last, int column) const noexcept {
  const Grid& grid = pattern_.grid;
  double length = 0.0;
  for (int i = first + 1; i <= last; ++i) length += pattern_.warp_rest[grid.index(i, column)];
  const double apart = (position.at(grid.index(last, column)) - position.at(grid.index(first, column))).norm();
  return apart >= (1.0 - scene_.solver.stretch_tolerance) * length;
}

// True: others are held than before.
bool TautColumns::find(const ClothState& state) noexcept {
  bool changed = false;
  const auto set = [&](std::size_t node, std::uint8_t held) {
    changed = changed || held_[node] != held;
    held_[node] = held;
  };
  for (std::size_t n = 0; n < held_.size(); ++n) {
    if (isPin(n)) set(n, 0);
  }
  forEachSpan([&](int first, int last, int column) {
    const std::uint8_t held = isStraight(state.position, first, last, column) ? 1 : 0;
    for (int i = first + 1; i < last; ++i) set(pattern_.grid.index(i, column), held);
  });
  if (changed) list();
  return changed;
}

void TautColumns::list() noexcept {
  list_.clear();
  for (std::size_t n = 0; n < held_.size(); ++n) {
    if (held_[n] != 0) list_.push_back(n);
  }
}

void TautColumns::reset(ClothState& state) {
  std::fill(others_.begin(), others_.end(), std::uint8_t{0});
  std::fill(held_.begin(), held_.end(), std::uint8_t{0});
  list_.clear();
  find(state);
}

// Those whose pins were let go since are free.
void TautColumns::pin(std::vector<std::uint8_t>& pinned) const noexcept {
  others_ = pinned;
  forEachSpan([&](int first, int last, int column) {
    for (int i = first + 1; i < last; ++i) {
      const std::size_t node = pattern_.grid.index(i, column);
      if (held_[node] != 0) pinned[node] = kHeld;
    }
  });
}

// Its nodes keep their places along the line between the pins, whose velocities are set. Pins that come nearer in the
// frame let them go.
bool TautColumns::beginFrame(const FrameBegin& begin, ClothState& state) noexcept {
  const Grid& grid = pattern_.grid;
  bool changed = false;
  forEachSpan([&](int first, int last, int column) {
    double length = 0.0, along = 0.0;
    for (int i = first + 1; i <= last; ++i) length += pattern_.warp_rest[grid.index(i, column)];
    const std::size_t a = grid.index(first, column), b = grid.index(last, column);
    const Vec3 from = state.velocity.at(a), to = state.velocity.at(b);
    const Vec3 apart = state.position.at(b) - state.position.at(a) + (to - from) / begin.rate;
    const bool straight = apart.norm() >= (1.0 - scene_.solver.stretch_tolerance) * length;
    for (int i = first + 1; i < last; ++i) {
      const std::size_t node = grid.index(i, column);
      along += pattern_.warp_rest[node];
      if (!isHeld(node)) continue;
      if (straight) {
        state.velocity.set(node, from + along / length * (to - from));
      } else {
        held_[node] = 0;
        changed = true;
      }
    }
  });
  if (changed) list();
  return changed;
}

bool TautColumns::endFrame(const FrameEnd&, ClothState& state) noexcept {
  for (std::size_t n = 0; n < held_.size(); ++n) {
    if (isHeld(n)) state.velocity.set(n, Vec3::Zero());
  }
  return find(state);
}

void TautColumns::serialize(Archive& archive) {
  archive.list("taut_columns", list_, [&](std::size_t& node) { archive.node("node", node, pattern_.grid); });
}

void TautColumns::resume() {
  std::fill(held_.begin(), held_.end(), std::uint8_t{0});
  for (const std::size_t node : list_) held_[node] = 1;
}

}  // namespace curtain
