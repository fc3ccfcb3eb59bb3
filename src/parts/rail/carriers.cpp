// SPDX-License-Identifier: BSD-3-Clause
//
// Carriers in a substep.
#include <cmath>
#include <limits>

#include "parts/rail/rail.h"
#include "scene/infinity.h"

namespace curtain {
namespace {

// The top row's.
std::vector<std::size_t> nodesOf(const std::vector<RailPattern>& rails) {
  std::vector<std::size_t> nodes;
  for (const RailPattern& rail : rails) nodes.insert(nodes.end(), rail.columns.begin(), rail.columns.end());
  return nodes;
}

}  // namespace

Rail::Rail(const Scene& scene, const ClothPattern& pattern)
    : GuidePart(pattern.grid, nodesOf(pattern.rails)), scene_(scene), pattern_(pattern) {
  for (const RailPattern& rail : pattern.rails) {
    const std::size_t first = all_.size();
    for (std::size_t k = 0; k < rail.size(); ++k) {
      const int column = rail.columns[k];
      all_.emplace_back().column = column;
      const bool left = k > 0 && rail.columns[k - 1] + 1 == column;
      const bool right = k + 1 < rail.size() && rail.columns[k + 1] == column + 1;
      adjacent_.push_back(left || right ? 1 : 0);
      track_of_.push_back(tracks_.size());
      fastened_.push_back(rail.fastened[k]);
    }
    tracks_.push_back({rail,
                       first,
                       all_.size(),
                       RailLaw(rail.size(), rail.gap, rail.path.length()),
                       {},
                       std::vector<double>(rail.layout.masters().size(), 0.0)});
    tracks_.back().asked.drive = driveOf(tracks_.back());
  }
  rows_.resize(all_.size());
}

void Rail::forget() noexcept {
  for (Carrier& carrier : all_) {
    carrier.stays = true;
    carrier.joins = false;
    carrier.force = carrier.drawn = 0.0;
  }
}

void Rail::begin(const SubstepStart& substep, const ClothState& state, const Field& inverse) noexcept {
  const ClothState& start = substep.state;
  step_ = substep.h;
  scale_ = substep.h * substep.kick;
  stands_ = false;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    Carrier& carrier = all_[k];
    RailRow& row = rows_[k];
    carrier.mobility = inverse[node(carrier)];
    carrier.inverse = isHeld(k) ? 1.0 / pattern_.mass[node(carrier)] : carrier.mobility;
    stands_ = stands_ || !(carrier.inverse > 0.0);
    carrier.along = carrier.now = pathOf(k).at(start.place[k]).tangent;
    carrier.point = start.position.at(node(carrier));
    carrier.moved = false;
    carrier.began = start.place[k];
    carrier.entered = start.velocity.at(node(carrier)).dot(carrier.along);
    row = RailRow();
    row.mass = 1.0 / carrier.inverse;
    row.wish = row.place = start.place[k];
    row.friction = {state.place[k], isFastened(k) ? kInfinity : 0.0};
    setFreedom(k);
  }
  for (const Track& track : tracks_) {
    if (!track.asked.draws) continue;
    const std::vector<std::size_t>& masters = track.rail.layout.masters();
    for (std::size_t m = 0; m < masters.size(); ++m) {
      const std::size_t k = track.first + masters[m];
      const double from = state.place[k], most = std::abs(track.asked.drive.speed * step_);
      rows_[k].drive = {from + std::clamp(track.goal[m] - from, -most, most), scale_ * track.asked.drive.force};
    }
  }
}

// The rail's reaction across itself carries what acts there and turns the carrier in its arc.
void Rail::bindFriction(std::size_t k, const Vec3& force) noexcept {
  if (isFastened(k)) return;
  const RailPath::Place at = pathOf(k).at(rows_[k].place);
  const double speed = (rows_[k].place - all_[k].began) / step_;
  const Vec3 across =
      force - force.dot(at.tangent) * at.tangent - pattern_.mass[node(all_[k])] * speed * speed * at.curvature;
  const double bound = scale_ * tracks_[track_of_[k]].rail.friction * across.norm();
  rows_[k].friction.bound = std::isfinite(bound) ? bound : 0.0;
}

// Links pull along their directions, and what they pull by moves it along the rail from where it is.
void Rail::setFreedom(std::size_t k) noexcept {
  const Carrier& carrier = all_[k];
  const double moves = carrier.mobility > 0.0 ? 1.0 : 0.0;
  guided(k).freedom = moves * carrier.along * carrier.along.transpose();
  guided(k).newton = moves * carrier.now * carrier.along.transpose();
}

void Rail::press(const NodeForce& force) noexcept {
  for (std::size_t k = 0; k < all_.size(); ++k) bindFriction(k, force.at(0, all_[k].column));
}

void Rail::put(std::size_t k, double place, Field3& position) noexcept {
  Carrier& carrier = all_[k];
  const RailPath::Place at = pathOf(k).at(place);
  carrier.now = at.tangent;
  carrier.point = at.point;
  position.set(node(carrier), at.point);
}

void Rail::settlePositions(int first, int end, Field3& position) noexcept {
  for (auto k = static_cast<std::size_t>(from(first) - all_.data()); k < all_.size() && all_[k].column < end; ++k) {
    const double change = all_[k].along.dot(position.at(node(all_[k])) - all_[k].point);
    rows_[k].wish += change;
    if (all_[k].mobility > 0.0) rows_[k].place += change;
    put(k, rows_[k].place, position);
    setFreedom(k);
  }
}

bool Rail::settle(Field3& position) noexcept {
  for (std::size_t k = 0; k < all_.size(); ++k)
    rows_[k].wish += all_[k].along.dot(position.at(node(all_[k])) - all_[k].point);
  for (Track& track : tracks_) track.law.solve(rows_.data() + track.first);
  bool changed = false;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    Carrier& carrier = all_[k];
    put(k, rows_[k].place, position);
    carrier.moved = carrier.moved || (carrier.mobility == 0.0 && !rows_[k].stays);
    // A string between neighbouring columns must have an end that moves, so that its pull can grow until one does.
    const bool may_stay = !carrier.moved && (adjacent_[k] == 0 || isFastened(k));
    const double mobility = rows_[k].stays && may_stay ? 0.0 : carrier.inverse;
    changed = changed || mobility != carrier.mobility;
    carrier.mobility = mobility;
    setFreedom(k);
  }
  return changed;
}

void Rail::followDirections() noexcept {
  for (std::size_t k = 0; k < all_.size(); ++k) {
    all_[k].along = all_[k].now;
    setFreedom(k);
  }
}

void Rail::commit(ClothState& state) noexcept {
  forget();
  for (std::size_t k = 0; k < all_.size(); ++k) {
    const RailRow& row = rows_[k];
    state.place[k] = row.place;
    state.velocity.set(node(all_[k]), (row.place - all_[k].began) / step_ * all_[k].now);
    if (stands_) continue;
    all_[k].stays = row.stays;
    all_[k].force = row.mass * (row.place - row.wish) / scale_;
    all_[k].drawn = row.drawn / scale_;
  }
  if (stands_) return;
  for (const Track& track : tracks_) {
    track.law.forEachRun([&](std::size_t first, std::size_t end) {
      for (std::size_t k = first; k + 1 < end; ++k) all_[track.first + k].joins = true;
    });
  }
}

void Rail::substepDone(const SubstepMade& made) noexcept {
  for (Track& track : tracks_) {
    double sum = 0.0;
    for (std::size_t k = track.first; k < track.end; ++k) sum += std::abs(all_[k].drawn);
    track.impulse += made.h * sum;
  }
}

// An impulse puts in itself times the mean speed; that of the drive is its multiplier over the step.
double Rail::energy() const noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    const double made = (rows_[k].place - all_[k].began) / step_;
    sum += rows_[k].drawn / step_ * (all_[k].entered + made);
  }
  return sum;
}

double Rail::work(const Field3& before, const Field3& after, double kick) const noexcept {
  double sum = 0.0;
  for (std::size_t k = 0; k < all_.size(); ++k) {
    const Vec3 mean = 0.5 * (before.at(node(all_[k])) + after.at(node(all_[k])));
    sum += kick * all_[k].drawn * mean.dot(all_[k].now);
  }
  return sum;
}

void Rail::beginRates(const ClothState& state, double age, Field3& velocity) noexcept {
  for (std::size_t k = 0; k < all_.size(); ++k) {
    Carrier& carrier = all_[k];
    const std::size_t n = node(carrier);
    carrier.now = carrier.along = pathOf(k).at(state.place[k]).tangent;
    carrier.mobility = all_[k].stays ? 0.0 : 1.0 / pattern_.mass[n];
    const Vec3 v = all_[k].stays ? state.velocity.at(n) : velocity.at(n);
    carrier.speed = v.dot(carrier.now) + age * carrier.mobility * all_[k].force;
    velocity.set(n, carrier.speed * carrier.now);
    setFreedom(k);
  }
}

void Rail::settleVelocities(int first, int end, Field3& velocity) noexcept {
  for (auto k = static_cast<std::size_t>(from(first) - all_.data()); k < all_.size() && all_[k].column < end; ++k) {
    Carrier& carrier = all_[k];
    if (carrier.mobility > 0.0) carrier.speed = velocity.at(node(carrier)).dot(carrier.now);
    velocity.set(node(carrier), carrier.speed * carrier.now);
  }
}

// Those of a run move as one.
void Rail::settleRates(Field3& velocity) noexcept {
  settleVelocities(0, pattern_.grid.columns, velocity);
  for (std::size_t first = 0, end = 0; first < all_.size(); first = end) {
    double mass = 0.0, moment = 0.0;
    bool more = true;
    for (end = first; end < all_.size() && more; ++end) {
      mass += pattern_.mass[node(all_[end])];
      moment += pattern_.mass[node(all_[end])] * all_[end].speed;
      more = all_[end].joins;
    }
    for (std::size_t k = first; k < end && end - first > 1; ++k) {
      if (all_[k].mobility == 0.0) continue;
      all_[k].speed = moment / mass;
      velocity.set(node(all_[k]), all_[k].speed * all_[k].now);
    }
  }
}

void Rail::save(std::vector<double>& memory) const {
  memory.clear();
  for (const Carrier& carrier : all_)
    memory.insert(memory.end(), {carrier.stays ? 1.0 : 0.0, carrier.joins ? 1.0 : 0.0, carrier.force, carrier.drawn});
}

void Rail::restore(const std::vector<double>& memory) noexcept {
  for (std::size_t k = 0; k < all_.size(); ++k) {
    all_[k].stays = memory[4 * k] != 0.0;
    all_[k].joins = memory[4 * k + 1] != 0.0;
    all_[k].force = memory[4 * k + 2];
    all_[k].drawn = memory[4 * k + 3];
  }
}

}  // namespace curtain
