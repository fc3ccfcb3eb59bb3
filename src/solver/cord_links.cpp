// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cord_links.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/weft_links.h"

namespace curtain {

CordLinks::CordLinks(const ClothPattern& pattern, double most_give, double links)
    : pattern_(pattern), most_give_(most_give), links_(links) {
  for (const Cord& cord : pattern.cords.cords) {
    CordLink link;
    link.node = cord.node;
    link.end = pattern.cords.ends[cord.end].node;
    setLength(link, cord.length);
    all_.push_back(link);
  }
  for (const LoopPattern& loop : pattern.cords.loops) closed_.push_back(loop.closed ? 1 : 0);
  reach_.assign(closed_.size(), 0.0);
  best_.assign(all_.size(), 0.0);
}

void CordLinks::setLength(CordLink& link, double length) noexcept {
  link.length = length;
  link.unit = std::min(length, links_);
}

// ---- Tie-backs

void CordLinks::close(std::size_t loop, bool closed, ClothState& state) noexcept {
  const CordEnd& end = pattern_.cords.ends[pattern_.cords.loops[loop].end];
  closed_[loop] = closed ? 1 : 0;
  if (closed) state.reach[loop] = reachOf(pattern_.cords, loop, state.position);
  for (std::size_t c = end.first; c < end.last; ++c) all_[c].last = 0.0;
  pulls_ = std::any_of(all_.begin(), all_.end(), [](const CordLink& link) { return link.last != 0.0; });
  takeLengths(state);
}

void CordLinks::resetLoops(ClothState& state) noexcept {
  for (std::size_t k = 0; k < closed_.size(); ++k) close(k, pattern_.cords.loops[k].closed, state);
}

bool CordLinks::closing(const ClothState& state) const noexcept {
  for (std::size_t k = 0; k < closed_.size(); ++k) {
    if (closed_[k] != 0 && state.reach[k] > pattern_.cords.loops[k].radius) return true;
  }
  return false;
}

void CordLinks::takeLengths(const ClothState& state) noexcept {
  for (std::size_t k = 0; k < closed_.size(); ++k) {
    const LoopPattern& loop = pattern_.cords.loops[k];
    const CordEnd& end = pattern_.cords.ends[loop.end];
    reach_[k] = state.reach[k];
    for (std::size_t c = end.first; c < end.last; ++c) {
      setLength(all_[c], reach_[k]);
      all_[c].rate = closed_[k] != 0 && reach_[k] > loop.radius ? -loop.speed : 0.0;
    }
  }
}

void CordLinks::takeTies(const Field& inverse) noexcept {
  for (CordLink& link : all_) link.ties = inverse[link.node] + inverse[link.end] > 0.0;
  for (std::size_t k = 0; k < closed_.size(); ++k) {
    const CordEnd& end = pattern_.cords.ends[pattern_.cords.loops[k].end];
    for (std::size_t c = end.first; c < end.last && closed_[k] == 0; ++c) all_[c].ties = false;
  }
}

// ---- A substep

void CordLinks::begin(const ClothState& state, const Field& inverse, double h, bool shrinks) noexcept {
  takeLengths(state);
  takeTies(inverse);
  closing_speed_ = 0.0;
  for (std::size_t k = 0; k < closed_.size(); ++k) {
    const LoopPattern& loop = pattern_.cords.loops[k];
    const CordEnd& end = pattern_.cords.ends[loop.end];
    const double shrunk = std::max(loop.radius, reach_[k] - std::abs(loop.speed * h));
    if (closed_[k] != 0 && shrinks && shrunk < reach_[k]) {
      reach_[k] = shrunk;
      closing_speed_ = std::max(closing_speed_, loop.speed);
    }
    for (std::size_t c = end.first; c < end.last; ++c) setLength(all_[c], reach_[k]);
  }
}

void CordLinks::predict(const SubstepStart& start, const Field& inverse, Field3& next) const noexcept {
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

bool CordLinks::warmStart(double ratio) noexcept {
  for (CordLink& link : all_) link.multiplier = link.ties ? ratio * link.last : 0.0;
  return pulls_ && ratio != 0.0;
}

void CordLinks::setDirections(const Field3& position) noexcept {
  for (CordLink& link : all_) link.direction = position.at(link.end) - position.at(link.node);
}

void CordLinks::move(const CordLink& link, double multiplier, const Field& inverse, Field3& value) const noexcept {
  value.add(link.node, (inverse[link.node] * multiplier) * link.direction);
  value.add(link.end, (-inverse[link.end] * multiplier) * link.direction);
}

void CordLinks::pull(const Field& inverse, Field3& value) const noexcept {
  for (const CordLink& link : all_) move(link, link.multiplier, inverse, value);
}

// [m^2]; the same compliance as the weft's, for lines that are taut against each other.
double CordLinks::violationOf(const CordLink& link, const Field& inverse, const Field3& position,
                              bool& active) const noexcept {
  const double square = (position.at(link.end) - position.at(link.node)).squaredNorm();
  const double load = kWeftCompliance * (inverse[link.node] + inverse[link.end]) * link.multiplier;
  const double give = std::min(load, most_give_) * link.length * link.length;
  const double violation = link.ties ? 0.5 * (square - link.length * link.length) - give : 0.0;
  active = link.ties && (violation > 0.0 || link.multiplier > 0.0);
  return std::isfinite(square) ? violation : std::numeric_limits<double>::infinity();
}

double CordLinks::measure(const Field& inverse, const Field3& position) noexcept {
  double worst = 0.0;
  for (CordLink& link : all_) {
    link.violation = violationOf(link, inverse, position, link.active);
    if (!std::isfinite(link.violation)) return std::numeric_limits<double>::infinity();
    if (link.active) worst = std::max(worst, std::abs(link.violation) / (link.length * link.unit));
  }
  return worst;
}

double CordLinks::residual(const Field& inverse, const Field3& position) const noexcept {
  double worst = 0.0;
  for (const CordLink& link : all_) {
    bool active = false;
    const double violation = violationOf(link, inverse, position, active);
    if (active || !std::isfinite(violation)) worst = std::max(worst, std::abs(violation) / (link.length * link.unit));
  }
  return worst;
}

double CordLinks::squares() const noexcept {
  double sum = 0.0;
  for (const CordLink& link : all_) {
    const double relative = link.active ? link.violation / (link.length * link.unit) : 0.0;
    sum += relative * relative;
  }
  return sum;
}

// A row's multiplier is the cord's times its length: the direction is a unit vector, as a contact's.
void CordLinks::addRows(Rows& rows) const {
  for (std::size_t c = 0; c < all_.size(); ++c) {
    const CordLink& link = all_[c];
    if (!link.ties) continue;
    Row row;
    row.node = {static_cast<std::uint32_t>(link.node), static_cast<std::uint32_t>(link.end)};
    row.weight = {1.0, -1.0};
    row.nodes = 2;
    row.direction = link.direction / link.length;
    row.violation = link.violation / link.length;
    row.least = -link.multiplier * link.length;
    row.active = link.active;
    row.with_rods = true;
    row.key = static_cast<std::uint32_t>(c);
    rows.push_back(row);
  }
}

void CordLinks::moveByRows(RowRange rows, const Field& inverse, Field3& value) const noexcept {
  for (const Row& row : rows) move(all_[row.key], row.change / all_[row.key].length, inverse, value);
}

void CordLinks::takeUp(RowRange rows, double share) noexcept {
  for (const Row& row : rows) {
    CordLink& link = all_[row.key];
    link.multiplier = std::max(0.0, link.multiplier + share * row.change / link.length);
  }
}

void CordLinks::saveIterate() noexcept {
  for (std::size_t c = 0; c < all_.size(); ++c) best_[c] = all_[c].multiplier;
}

void CordLinks::restoreIterate() noexcept {
  for (std::size_t c = 0; c < all_.size(); ++c) all_[c].multiplier = best_[c];
}

double CordLinks::commit(const SubstepStart& start, const Field3& next, ClothState& state, Field& load) noexcept {
  pulls_ = false;
  for (const CordEnd& end : pattern_.cords.ends) {
    state.velocity.set(end.node, (next.at(end.node) - start.state.position.at(end.node)) / start.h);
    load[end.node] = 0.0;
  }
  for (CordLink& link : all_) {
    link.last = link.multiplier;
    load[link.end] += link.last;
    pulls_ = pulls_ || link.last != 0.0;
  }
  double heaviest = 0.0;
  for (const CordLink& link : all_) load[link.node] += link.last;
  for (const CordLink& link : all_) heaviest = std::max(heaviest, load[link.node] * pattern_.inverse_mass[link.node]);
  for (const CordEnd& end : pattern_.cords.ends)
    heaviest = std::max(heaviest, load[end.node] * pattern_.inverse_mass[end.node]);
  std::copy(reach_.begin(), reach_.end(), state.reach.begin());
  takeLengths(state);
  return heaviest;
}

// ---- The last accepted substep

Vec3 CordLinks::sumAt(std::size_t node, double CordLink::*multiplier) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (const CordLink& link : all_) {
    if (link.node == node) sum += link.*multiplier * link.direction;
    if (link.end == node) sum -= link.*multiplier * link.direction;
  }
  return sum;
}

Vec3 CordLinks::pullAt(std::size_t node) const noexcept { return sumAt(node, &CordLink::last); }
Vec3 CordLinks::presentPullAt(std::size_t node) const noexcept { return sumAt(node, &CordLink::multiplier); }

void CordLinks::spread(double share, const Field& inverse, Field3& value) const noexcept {
  for (const CordLink& link : all_) move(link, share * link.last, inverse, value);
}

double CordLinks::stretch(const Field3& position) const noexcept {
  double longest = 0.0;
  for (std::size_t c = 0; c < all_.size(); ++c) {
    const CordLink& link = all_[c];
    if (!link.ties) continue;
    longest = std::max(longest, (position.at(link.end) - position.at(link.node)).norm() / link.length - 1.0);
  }
  return longest;
}

double CordLinks::measureRates(const Field3& velocity) noexcept {
  double worst = 0.0;
  for (CordLink& link : all_) {
    link.active = link.last > 0.0;
    const Vec3 apart = velocity.at(link.end) - velocity.at(link.node);
    link.violation = link.active ? link.direction.dot(apart) - link.length * link.rate : 0.0;
    worst = std::max(worst, std::abs(link.violation) / (link.length * link.unit));
  }
  return worst;
}

void CordLinks::save(Memory& memory) const {
  memory.last.resize(all_.size());
  for (std::size_t c = 0; c < all_.size(); ++c) memory.last[c] = all_[c].last;
}

void CordLinks::restore(const Memory& memory) noexcept {
  pulls_ = false;
  for (std::size_t c = 0; c < all_.size(); ++c) {
    all_[c].last = memory.last[c];
    pulls_ = pulls_ || all_[c].last != 0.0;
  }
}

void CordLinks::forget() noexcept {
  for (CordLink& link : all_) link.last = link.multiplier = 0.0;
  pulls_ = false;
}

void CordLinks::resume(const ClothState& state) noexcept {
  pulls_ = std::any_of(all_.begin(), all_.end(), [](const CordLink& link) { return link.last != 0.0; });
  takeLengths(state);
  takeTies(pattern_.inverse_mass);
}

}  // namespace curtain
