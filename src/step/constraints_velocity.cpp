// SPDX-License-Identifier: BSD-3-Clause
//
// Velocity projection: links keep their lengths, contacts do not penetrate.
#include "step/constants.h"
#include "step/constraints.h"

namespace curtain {

// Applies a share of the last substep's forces between nodes to the velocities, and leaves it in the multipliers.
void Constraints::spreadForces(const LineSolve& warp, const LineSolve& weft, const Contacts* contacts,
                               double share) noexcept {
  forEachBlock([&](int block) {
    for (int i = 0; i < pattern_.grid.rows; ++i) {
      const std::size_t first = pattern_.grid.row(i) + static_cast<std::size_t>(block) * kLane;
      for (std::size_t n = first; n < first + kLane; ++n) warp_.multiplier[n] = share * last_warp_[n];
    }
    applyWarpMultipliers(warp, block);
  });
  if (weft_pulls_) {
    for (std::size_t n = 0; n < pattern_.grid.size(); ++n) change_[n] = share * last_weft_[n];
    for (int i = 0; i < pattern_.grid.rows; ++i) pullWeft(weft, i, change_);
  }
  distances_.spread(share, inertia_.masses(), warp.value);
  for (std::size_t n = 0; contacts != nullptr && n < contacts->size(); ++n) {
    const Contact& contact = (*contacts)[n];
    if (contact.pushes())
      contact.move(inertia_.masses(), share * (contact.push * contact.normal + contact.slide), warp.value);
  }
}

void Constraints::addPulls(const Field3& position, const Contacts* contacts, double share, Field3& velocity) noexcept {
  setWarpDirections(pattern_.grid, position, warp_.direction);
  if (stringsPull()) setWeftDirectionsAt(position);
  spreadForces({pattern_, inertia_.masses(), warp_, velocity}, {pattern_, inertia_.masses(), weft_, velocity}, contacts,
               share);
}

void Constraints::project(const Field3& position, const Contacts* contacts, double share, Field3& velocity) noexcept {
  setWarpDirections(pattern_.grid, position, warp_.direction);

  const LineSolve warp{pattern_, inertia_.masses(), warp_, velocity, guide_};
  const LineSolve weft{pattern_, inertia_.masses(), weft_, velocity, guide_};
  const bool presses = contacts != nullptr && anyPushes(*contacts);
  const bool alone = !stringsPull() && !presses;
  const auto settle = [&] {
    if (guide_ != nullptr) guide_->settleRates(velocity);
  };
  const auto solveRods = [&] {
    forEachBlock([&](int block) { warpProjectVelocity(warp, scratch_, block); });
    settle();
  };
  if (weft_pulls_) std::copy(last_weft_.begin(), last_weft_.end(), weft_.multiplier.begin());  // which links pull
  if (!alone) setWeftDirectionsAt(position);
  if (share > 0.0) spreadForces(warp, weft, contacts, share);
  settle();
  solveRods();
  if (alone) return;
  net_.begin(position, inertia_.masses(), guide_);
  double first_rate = 0.0;
  for (int round = 0; round < (presses ? kContactRounds : kVelocityRounds); ++round) {
    double rate = worstOfRows([&](int i) { return measureWeftRates(weft, i, violation_, active_); });
    if (distances_.any()) rate = std::max(rate, distances_.measureRates(velocity));
    if (presses) rate = std::max(rate, contactRate(*contacts, velocity) / middle_rest_);
    if (round == 0) first_rate = rate;
    if (rate == 0.0 || (round > 0 && rate <= kVelocityReduction * first_rate)) break;
    rows_.clear();
    if (presses) addContactRateRows(*contacts, velocity, rows_);
    contact_rows_ = rows_.size();
    distances_.addRows(rows_);
    net_.solve(violation_, active_, rows_,
               {rate * middle_rest_, kVelocityDamping, kVelocityReduction, kVelocityIterations}, change_);
    for (int i = 0; i < pattern_.grid.rows; ++i) pullWeft(weft, i, change_);
    distances_.moveByRows(distanceRows(), inertia_.masses(), velocity);
    if (presses) moveByContacts(inertia_.masses(), contactRows(), *contacts, velocity);
    settle();
    solveRods();
  }
  if (weft_pulls_) std::fill(weft_.multiplier.begin(), weft_.multiplier.end(), 0.0);
}

}  // namespace curtain
