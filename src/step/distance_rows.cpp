// SPDX-License-Identifier: BSD-3-Clause
#include "step/distance_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curtain {
namespace {

// Relative overlength of a row for each unit of its multiplier times (w_a + w_b): it keeps rows that are taut against
// each other, a singular system, solvable.
constexpr double kCompliance = 1e-7;

}  // namespace

DistanceRows::DistanceRows(const ClothPattern& pattern, std::vector<RowPart*> parts, double max_give, double links)
    : pattern_(pattern), parts_(std::move(parts)), max_give_(max_give), links_(links) {
  std::size_t count = 0;
  for (const RowPart* part : parts_) count += part->count();
  all_.resize(count);
  best_.assign(count, 0.0);
  std::size_t first = 0;
  for (RowPart* part : parts_) {
    part->attach(all_.data() + first);
    first += part->count();
  }
}

// What overlengths are measured by [m]: the length, but not more than that of a weft link, so that heavy loads on long
// rows don't shake the cloth by what a long row's tolerance is.
double DistanceRows::unitOf(const DistanceRow& row) const noexcept { return std::min(row.length, links_); }

// ---- A substep

bool DistanceRows::begin(const SubstepStart& start, const ClothState& state, const Field& inverse, bool drives,
                         double ratio, Field3& next) noexcept {
  scale_ = start.h * start.kick;
  for (RowPart* part : parts_) part->begin(start, state, inverse, drives, next);
  for (DistanceRow& row : all_) row.multiplier = row.holds ? ratio * row.last : 0.0;
  return ratio != 0.0 && pulls();
}

void DistanceRows::setDirections(const Field3& position) noexcept {
  for (DistanceRow& row : all_) row.direction = position.at(row.other) - position.at(row.node);
}

void DistanceRows::move(const DistanceRow& row, double multiplier, const Field& inverse, Field3& value) const noexcept {
  value.add(row.node, (inverse[row.node] * multiplier) * row.direction);
  value.add(row.other, (-inverse[row.other] * multiplier) * row.direction);
}

void DistanceRows::pull(const Field& inverse, Field3& value) const noexcept {
  for (const DistanceRow& row : all_) move(row, row.multiplier, inverse, value);
}

// How much less the row's violation [m] grows for each unit of its multiplier [1/kg]: the pull is multiplier * |d| /
// scale, and what it gives counts by the mean of |r| and the length, as C = (|r|^2 - length^2) / 2 does.
double DistanceRows::givesPerMultiplier(const DistanceRow& row, double distance) const noexcept {
  return 0.5 * row.compliance * row.direction.norm() * (distance + row.length) / scale_;
}

double DistanceRows::measure(const Field& inverse, const Field3& position) noexcept {
  double worst = 0.0;
  for (DistanceRow& row : all_) {
    const double square = (position.at(row.other) - position.at(row.node)).squaredNorm();
    const double load = kCompliance * (inverse[row.node] + inverse[row.other]) * row.multiplier;
    const double give = std::min(load, max_give_) * row.length * row.length;
    row.violation = row.holds ? 0.5 * (square - row.length * row.length) - give : 0.0;
    if (row.compliance > 0.0 && row.holds) row.violation -= givesPerMultiplier(row, std::sqrt(square)) * row.multiplier;
    row.active = row.holds && (row.violation > 0.0 || row.multiplier > 0.0);
    if (!std::isfinite(square + row.violation)) return std::numeric_limits<double>::infinity();
    if (row.active) worst = std::max(worst, std::abs(row.violation) / (row.length * unitOf(row)));
  }
  return worst;
}

void DistanceRows::addSquares(const Field3& /*position*/, double& sum) const noexcept {
  double own = 0.0;
  for (const DistanceRow& row : all_) {
    const double relative = row.active ? row.violation / (row.length * unitOf(row)) : 0.0;
    own += relative * relative;
  }
  sum += own;
}

// A row's multiplier is the distance's times its length: the direction is a unit vector, as a contact's.
void DistanceRows::addRows(const Field3& /*value*/, bool rates, Rows& rows) const {
  for (std::size_t r = 0; r < all_.size(); ++r) {
    const DistanceRow& distance = all_[r];
    if (!distance.holds) continue;
    Row row;
    row.node = {static_cast<std::uint32_t>(distance.node), static_cast<std::uint32_t>(distance.other)};
    row.weight = {1.0, -1.0};
    row.nodes = 2;
    row.direction = distance.direction / distance.length;
    row.violation = distance.violation / distance.length;
    if (!rates) row.least = -distance.multiplier * distance.length;
    row.active = distance.active;
    if (distance.compliance > 0.0)
      row.compliance = givesPerMultiplier(distance, distance.direction.norm()) / (distance.length * distance.length);
    row.key = static_cast<std::uint32_t>(r);
    rows.push_back(row);
  }
}

void DistanceRows::moveBy(const Rows& rows, const Field& inverse, Field3& value) noexcept {
  for (std::size_t r = first_row; r < end_row; ++r) {
    const DistanceRow& distance = all_[rows[r].key];
    move(distance, rows[r].change / distance.length, inverse, value);
  }
}

void DistanceRows::applyChange(const Rows& rows, double share, const Field& /*inverse*/,
                               Field3& /*position*/) noexcept {
  for (std::size_t r = first_row; r < end_row; ++r) {
    DistanceRow& distance = all_[rows[r].key];
    distance.multiplier = std::max(0.0, distance.multiplier + share * rows[r].change / distance.length);
  }
}

double DistanceRows::energy(const Field3& position) const noexcept {
  double sum = 0.0;
  for (const DistanceRow& row : all_) {
    if (!row.holds || !(row.compliance > 0.0)) continue;
    const double longer = std::max(0.0, (position.at(row.other) - position.at(row.node)).norm() - row.length);
    sum += 0.5 * longer * longer / row.compliance;
  }
  return sum;
}

double DistanceRows::speed() const noexcept {
  double fastest = 0.0;
  for (const DistanceRow& row : all_) fastest = std::max(fastest, std::abs(row.rate));
  return fastest;
}

void DistanceRows::saveIterate() noexcept {
  for (std::size_t r = 0; r < all_.size(); ++r) best_[r] = all_[r].multiplier;
}

void DistanceRows::restoreIterate() noexcept {
  for (std::size_t r = 0; r < all_.size(); ++r) all_[r].multiplier = best_[r];
}

double DistanceRows::commit(const SubstepStart& start, const Field3& next, ClothState& state, Field& load) noexcept {
  const Grid& grid = pattern_.grid;
  std::fill(load.begin() + static_cast<std::ptrdiff_t>(grid.row(grid.rows)), load.end(), 0.0);
  elastic_work_ = elasticWork(start, next);
  for (DistanceRow& row : all_) {
    row.last = row.multiplier;
    load[row.node] += row.last;
    load[row.other] += row.last;
  }
  double heaviest = 0.0;
  for (const DistanceRow& row : all_) {
    for (const std::size_t n : {row.node, row.other}) heaviest = std::max(heaviest, load[n] * pattern_.inverse_mass[n]);
  }
  for (RowPart* part : parts_) part->commit(start, next, state);
  return heaviest;
}

void DistanceRows::resume(const ClothState& state) noexcept {
  for (RowPart* part : parts_) part->resume(state);
}

// ---- The last accepted substep

bool DistanceRows::pulls() const noexcept {
  return std::any_of(all_.begin(), all_.end(), [](const DistanceRow& row) { return row.last != 0.0; });
}

Vec3 DistanceRows::sumAt(std::size_t node, double DistanceRow::*multiplier) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (const DistanceRow& row : all_) {
    if (row.node == node) sum += row.*multiplier * row.direction;
    if (row.other == node) sum -= row.*multiplier * row.direction;
  }
  return sum;
}

void DistanceRows::spread(double share, const Field& inverse, Field3& value) const noexcept {
  for (const DistanceRow& row : all_) move(row, share * row.last, inverse, value);
}

double DistanceRows::work(const Field3& before, const Field3& after, double per_h) const noexcept {
  double sum = 0.0;
  for (const RowPart* part : parts_) sum += part->work(before, after, per_h);
  return sum;
}

template <typename Wanted>
double DistanceRows::workOf(const Wanted& wanted, const SubstepStart& start, const Field3& next) const noexcept {
  const Field3 &from = start.state.position, &before = start.state.velocity;
  double sum = 0.0;
  for (const DistanceRow& row : all_) {
    if (!wanted(row)) continue;
    const Vec3 moved = next.at(row.node) - from.at(row.node) - next.at(row.other) + from.at(row.other);
    const Vec3 apart = before.at(row.node) - before.at(row.other) + moved / start.h;
    sum += 0.5 * row.multiplier / start.h * row.direction.dot(apart);
  }
  return sum;
}

double DistanceRows::elasticWork(const SubstepStart& start, const Field3& next) const noexcept {
  return workOf([](const DistanceRow& row) { return row.compliance > 0.0; }, start, next);
}

double DistanceRows::drivenWork(const SubstepStart& start, const Field3& next) const noexcept {
  return workOf([](const DistanceRow& row) { return row.rate != 0.0; }, start, next);
}

double DistanceRows::stretch(const Field3& position) const noexcept {
  double longest = 0.0;
  for (const DistanceRow& row : all_) {
    if (!row.holds || row.compliance > 0.0) continue;
    longest = std::max(longest, (position.at(row.other) - position.at(row.node)).norm() / row.length - 1.0);
  }
  return longest;
}

double DistanceRows::measureRates(const Field3& velocity) noexcept {
  double worst = 0.0;
  for (DistanceRow& row : all_) {
    row.active = row.last > 0.0 && row.compliance == 0.0;  // what gives is a force, no constraint of velocities
    const Vec3 apart = velocity.at(row.other) - velocity.at(row.node);
    row.violation = row.active ? row.direction.dot(apart) - row.length * row.rate : 0.0;
    worst = std::max(worst, std::abs(row.violation) / (row.length * unitOf(row)));
  }
  return worst;
}

void DistanceRows::save(Memory& memory) const {
  memory.last.resize(all_.size());
  for (std::size_t r = 0; r < all_.size(); ++r) memory.last[r] = all_[r].last;
}

void DistanceRows::restore(const Memory& memory) noexcept {
  for (std::size_t r = 0; r < all_.size(); ++r) all_[r].last = memory.last[r];
}

void DistanceRows::forget() noexcept {
  for (DistanceRow& row : all_) row.last = row.multiplier = 0.0;
}

}  // namespace curtain
