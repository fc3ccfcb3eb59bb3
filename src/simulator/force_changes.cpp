// SPDX-License-Identifier: BSD-3-Clause
//
// Which columns are reached by a source that begins, ends or changes.
#include "simulator/force_field.h"

namespace curtain {
namespace {

// An event on the border of two frames belongs to both, whatever the rounding [s].
constexpr double kSlack = 1e-9;

bool within(double time, double from, double to) { return time >= from - kSlack && time <= to + kSlack; }

}  // namespace

bool sameWhileItBlows(const WindParams& a, const WindParams& b) {
  return a.position == b.position && a.direction == b.direction && a.radius == b.radius &&
         a.half_angle == b.half_angle && a.pressure == b.pressure && a.node_force == b.node_force &&
         a.porosity_weight == b.porosity_weight && a.distance_weight == b.distance_weight &&
         a.reference_length == b.reference_length && a.unsteadiness == b.unsteadiness &&
         a.correlation_time == b.correlation_time && a.correlation_length == b.correlation_length;
}

bool sameWhileItActs(const DragParams& a, const DragParams& b) {
  const auto sameNode = [](const std::optional<NodeIndex>& p, const std::optional<NodeIndex>& q) {
    return p.has_value() == q.has_value() && (!p || (p->row == q->row && p->column == q->column));
  };
  const auto samePoint = [](const std::optional<Vec3>& p, const std::optional<Vec3>& q) {
    return p.has_value() == q.has_value() && (!p || *p == *q);
  };
  return sameNode(a.node, b.node) && samePoint(a.point, b.point) && a.force == b.force &&
         samePoint(a.target, b.target) && a.stiffness == b.stiffness && a.max_force == b.max_force &&
         a.radius == b.radius;
}

void ForceField::markReached(const WindSource& wind, const Field3& position, ColumnSet& out) const noexcept {
  const Grid& grid = pattern_.grid;
  for (int j = 0; j < grid.columns; ++j) {
    for (int i = 0; i < grid.rows && !out.has(j); ++i) {
      if (wind.at(position.at(grid.index(i, j))).reached) out.add(j);
    }
  }
}

void ForceField::markChanges(double from, double to, const Field3& position, ColumnSet& out) const noexcept {
  for (const WindSource& wind : winds_) {
    if (within(wind.params().start, from, to) || within(wind.params().end, from, to)) markReached(wind, position, out);
  }
  for (const DragForce& drag : drags_) {
    if (within(drag.params().start, from, to) || within(drag.params().end, from, to))
      drag.markColumns(pattern_.grid, out);
  }
}

void ForceField::markGusts(double time, const Field3& position, ColumnSet& out) const noexcept {
  for (const WindSource& wind : winds_) {
    if (wind.params().unsteadiness > 0.0 && wind.blowsAt(time)) markReached(wind, position, out);
  }
}

void ForceField::markWind(const std::string& id, const Field3& position, ColumnSet& out) const noexcept {
  for (const WindSource& wind : winds_) {
    if (wind.params().id == id) markReached(wind, position, out);
  }
}

void ForceField::markDrag(const std::string& id, ColumnSet& out) const noexcept {
  for (const DragForce& drag : drags_) {
    if (drag.params().id == id) drag.markColumns(pattern_.grid, out);
  }
}

bool ForceField::reaches(const std::string& id, double time, const Field3& position) const {
  ColumnSet columns(pattern_.grid.columns);
  for (const WindSource& wind : winds_) {
    if (wind.params().id == id && wind.blowsAt(time)) markReached(wind, position, columns);
  }
  return !columns.empty();
}

}  // namespace curtain
