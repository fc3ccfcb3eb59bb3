// SPDX-License-Identifier: BSD-3-Clause
#include "solver/held_columns.h"

#include <algorithm>
#include <cmath>

#include "solver/warp_solver.h"

namespace curtain {
namespace {

// Change of the pull on a column, over its weight, that does not wake it: the angle from the vertical at which the
// column would hang [rad].
constexpr double kWakeShare = 1e-4;

}  // namespace

HeldColumns::HeldColumns(const ClothPattern& pattern)
    : pattern_(pattern),
      weft_(weftLines(pattern)),
      mass_(static_cast<std::size_t>(pattern.grid.columns), 0.0),
      held_(pattern.grid.columns),
      disturbed_(pattern.grid.columns),
      borders_(pattern.grid.columns),
      skips_(static_cast<std::size_t>(warpBlockCount(pattern.grid)), 0) {
  const Grid& grid = pattern.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) mass_[static_cast<std::size_t>(j)] += pattern.mass[grid.index(i, j)];
  }
  pull_.assign(grid.size(), 0.0);
  if (weft_.bend()) bent_.assign(grid.size(), 0.0);
  span_ = {0, static_cast<std::size_t>(grid.columns)};
  for (int block = 0; block < warpBlockCount(grid); ++block) {
    skips_[static_cast<std::size_t>(block)] = block * kLane >= grid.columns ? 1 : 0;
  }
}

void HeldColumns::take(const ColumnSet& held) noexcept {
  const Grid& grid = pattern_.grid;
  held_ = held;
  span_ = {0, static_cast<std::size_t>(grid.columns)};
  while (!grid.closed && span_.first < span_.end && held.has(static_cast<int>(span_.first))) ++span_.first;
  while (!grid.closed && span_.first < span_.end && held.has(static_cast<int>(span_.end) - 1)) --span_.end;
  for (int block = 0; block < warpBlockCount(grid); ++block) {
    bool skips = true;
    for (int j = block * kLane; j < std::min((block + 1) * kLane, grid.columns); ++j) skips = skips && held.has(j);
    skips_[static_cast<std::size_t>(block)] = skips ? 1 : 0;
  }
}

void HeldColumns::resume(const ColumnSet& held) noexcept {
  take(held);
  disturbed_.clear();
  borders_.clear();
  for (int j = pattern_.grid.closed ? 0 : 1; j < pattern_.grid.columns; ++j) {
    if (held.has(j) != held.has(leftOf(j))) borders_.add(j);
  }
}

void HeldColumns::set(const ColumnSet& held, const Field3& position, const Field& weft, double per_scale) noexcept {
  const Grid& grid = pattern_.grid;
  for (int j = 0; weft_.bend() && j < grid.columns; ++j) {
    for (int i = 0; held.has(j) && !held_.has(j) && i < grid.rows; ++i)
      bent_.set(grid.index(i, j), weftBendingAt(grid, weft_, position, i, j));
  }
  take(held);
  for (int j = grid.closed ? 0 : 1; j < grid.columns; ++j) {
    const int left = leftOf(j);
    if (held.has(j) == held.has(left)) {
      borders_.remove(j);
    } else if (!borders_.has(j)) {
      borders_.add(j);
      for (int i = 0; i < grid.rows; ++i) {
        const std::size_t n = grid.index(i, j);
        pull_.set(n, (weft[n] * per_scale) * (position.at(n) - position.at(grid.index(i, left))));
      }
    }
  }
}

// Sum over the rows of the change of force at a border [N].
double HeldColumns::changeAtBorder(int column, const LinkSet* weft, double per_scale) const noexcept {
  const Grid& grid = pattern_.grid;
  double sum = 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t n = grid.index(i, column);
    Vec3 change = pull_.at(n);
    if (weft != nullptr) change -= (weft->multiplier[n] * per_scale) * weft->direction.at(n);
    sum += change.norm();
  }
  return sum;
}

// A moving column is so near that the weft's bending joins them.
bool HeldColumns::bendsWithMoving(int column) const noexcept {
  const int columns = pattern_.grid.columns;
  for (const int side : {-2, -1, 1, 2}) {
    const int other = pattern_.grid.closed ? (column + side + columns) % columns : column + side;
    if (other >= 0 && other < columns && !held_.has(other)) return true;
  }
  return false;
}

// Sum over the rows of the change of the weft's force on a held column [N].
double HeldColumns::changeOfBending(int column, const Field3& position) const noexcept {
  const Grid& grid = pattern_.grid;
  double sum = 0.0;
  for (int i = 0; i < grid.rows; ++i)
    sum += (weftBendingAt(grid, weft_, position, i, column) - bent_.at(grid.index(i, column))).norm();
  return sum;
}

bool HeldColumns::disturbedBy(const LinkSet* weft, const Field3& position, const Contacts* contacts, double per_scale,
                              double gravity, bool stuck) noexcept {
  disturbed_.clear();
  if (stuck) disturbed_ = held_;
  if (stuck) return true;
  for (int j = 0; j < pattern_.grid.columns; ++j) {
    if (!borders_.has(j)) continue;
    const int held = held_.has(j) ? j : leftOf(j);
    const double allowed = kWakeShare * mass_[static_cast<std::size_t>(held)] * gravity;
    if (!(changeAtBorder(j, weft, per_scale) <= allowed)) disturbed_.add(held);
  }
  for (int j = 0; weft_.bend() && j < pattern_.grid.columns; ++j) {
    if (!held_.has(j) || !bendsWithMoving(j)) continue;
    const double allowed = kWakeShare * mass_[static_cast<std::size_t>(j)] * gravity;
    if (!(changeOfBending(j, position) <= allowed)) disturbed_.add(j);
  }
  if (contacts == nullptr) return !disturbed_.empty();
  const auto stride = static_cast<std::uint32_t>(pattern_.grid.stride);
  for (const Contact& contact : *contacts) {
    if (!contact.pushes()) continue;
    for (int k = 0; k < contact.nodes; ++k) {
      const auto column = static_cast<int>(contact.node[static_cast<std::size_t>(k)] % stride);
      if (held_.has(column)) disturbed_.add(column);
    }
  }
  return !disturbed_.empty();
}

}  // namespace curtain
