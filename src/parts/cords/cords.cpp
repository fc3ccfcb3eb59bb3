// SPDX-License-Identifier: BSD-3-Clause
#include "parts/cords/cords.h"

#include <algorithm>

#include "cloth/archive.h"

namespace curtain {

Cords::Cords(const ClothPattern& pattern) : pattern_(pattern) {
  for (const LoopPattern& loop : pattern.cords.loops) closed_.push_back(loop.closed ? 1 : 0);
  reach_.assign(closed_.size(), 0.0);
}

void Cords::attach(DistanceRow* rows) noexcept {
  rows_ = rows;
  for (std::size_t c = 0; c < count(); ++c) {
    const Cord& cord = pattern_.cords.cords[c];
    rows_[c].node = cord.node;
    rows_[c].other = pattern_.cords.ends[cord.end].node;
    rows_[c].length = cord.length;
  }
}

// ---- Tie-backs

void Cords::close(std::size_t loop, bool closed, ClothState& state) noexcept {
  const CordEnd& end = pattern_.cords.ends[pattern_.cords.loops[loop].end];
  closed_[loop] = closed ? 1 : 0;
  if (closed) state.reach[loop] = reachOf(pattern_.cords, loop, state.position);
  for (std::size_t c = end.first; c < end.last; ++c) rows_[c].last = 0.0;
  resume(state);
}

void Cords::reset(ClothState& state) {
  for (std::size_t k = 0; k < closed_.size(); ++k) close(k, pattern_.cords.loops[k].closed, state);
}

void Cords::placed(const ClothState& before, ClothState& state) noexcept {
  for (const CordEnd& end : pattern_.cords.ends) {
    if (!end.load) continue;
    const double share = 1.0 / static_cast<double>(end.last - end.first);
    Vec3 moved = Vec3::Zero(), velocity = Vec3::Zero();
    for (std::size_t c = end.first; c < end.last; ++c) {
      const std::size_t n = pattern_.cords.cords[c].node;
      moved += share * (state.position.at(n) - before.position.at(n));
      velocity += share * state.velocity.at(n);
    }
    state.position.add(end.node, moved);
    state.velocity.set(end.node, velocity);
  }
  for (std::size_t k = 0; k < closed_.size(); ++k) close(k, closed(k), state);
}

bool Cords::explain(const ClothState&, double, Plan& plan) const {
  const CordsPattern& cords = pattern_.cords;
  plan.push_back({"lines", !cords.empty(),
                  cords.empty() ? "there are none"
                                : std::to_string(cords.cords.size()) + " cords of " +
                                      std::to_string(cords.ends.size() - cords.loops.size()) + " lines and " +
                                      std::to_string(cords.loops.size()) + " tie-backs"});
  return false;
}

bool Cords::isUnderWay(const ClothState& state) const noexcept {
  for (std::size_t k = 0; k < closed_.size(); ++k) {
    if (closed_[k] != 0 && state.reach[k] > pattern_.cords.loops[k].radius) return true;
  }
  return false;
}

// ---- A substep

void Cords::setLengths(const ClothState& state) noexcept {
  for (std::size_t k = 0; k < closed_.size(); ++k) {
    const LoopPattern& loop = pattern_.cords.loops[k];
    const CordEnd& end = pattern_.cords.ends[loop.end];
    reach_[k] = state.reach[k];
    for (std::size_t c = end.first; c < end.last; ++c) {
      rows_[c].length = reach_[k];
      rows_[c].rate = draws_ && closed_[k] != 0 && reach_[k] > loop.radius ? -loop.speed : 0.0;
    }
  }
}

void Cords::setHolds(const Field& inverse) noexcept {
  for (std::size_t c = 0; c < count(); ++c) rows_[c].holds = inverse[rows_[c].node] + inverse[rows_[c].other] > 0.0;
  for (std::size_t k = 0; k < closed_.size(); ++k) {
    const CordEnd& end = pattern_.cords.ends[pattern_.cords.loops[k].end];
    for (std::size_t c = end.first; c < end.last && closed_[k] == 0; ++c) rows_[c].holds = false;
  }
}

void Cords::begin(const SubstepStart& start, const ClothState& state, const Field& inverse, bool drives,
                  Field3& next) noexcept {
  draws_ = drives;
  setLengths(state);
  setHolds(inverse);
  for (std::size_t k = 0; k < closed_.size(); ++k) {
    const LoopPattern& loop = pattern_.cords.loops[k];
    const CordEnd& end = pattern_.cords.ends[loop.end];
    const double shrunk = std::max(loop.radius, reach_[k] - std::abs(loop.speed * start.h));
    if (closed_[k] != 0 && drives && shrunk < reach_[k]) reach_[k] = shrunk;
    for (std::size_t c = end.first; c < end.last; ++c) rows_[c].length = reach_[k];
  }
  predict(start, inverse, next);
}

// x + h (keep v + kick w F).
void Cords::predict(const SubstepStart& start, const Field& inverse, Field3& next) const noexcept {
  for (const CordEnd& end : pattern_.cords.ends) {
    const std::size_t n = end.node;
    const Vec3 v = start.state.velocity.at(n);
    Vec3 moved = v;
    if (inverse[n] > 0.0) {
      const Vec3 gained = start.uniform != nullptr ? *start.uniform : Vec3(inverse[n] * start.force.at(n));
      moved = (start.keep != nullptr ? (*start.keep)[n] : 1.0) * v + start.kick * gained;
    }
    next.set(n, start.state.position.at(n) + start.h * moved);
  }
}

void Cords::commit(const SubstepStart& start, const Field3& next, ClothState& state) noexcept {
  for (const CordEnd& end : pattern_.cords.ends)
    state.velocity.set(end.node, (next.at(end.node) - start.state.position.at(end.node)) / start.h);
  std::copy(reach_.begin(), reach_.end(), state.reach.begin());
  setLengths(state);
}

void Cords::resume(const ClothState& state) noexcept {
  setLengths(state);
  setHolds(pattern_.inverse_mass);
}

// Of loops that close.
double Cords::work(const Field3& before, const Field3& after, double per_h) const noexcept {
  double sum = 0.0;
  for (const LoopPattern& loop : pattern_.cords.loops) {
    const CordEnd& end = pattern_.cords.ends[loop.end];
    for (std::size_t c = end.first; c < end.last; ++c) {
      const DistanceRow& row = rows_[c];
      const Vec3 first = before.at(row.node) - before.at(row.other), last = after.at(row.node) - after.at(row.other);
      sum += per_h * row.last * row.direction.dot(0.5 * (first + last));
    }
  }
  return sum;
}

void Cords::serialize(Archive& archive) {
  archive.flags("closed", closed_);
  archive.flag("draws", draws_);
}

}  // namespace curtain
