// SPDX-License-Identifier: BSD-3-Clause
//
// Velocity projection: links keep their lengths, contacts do not penetrate.
#include "step/constants.h"
#include "step/constraints.h"

namespace curtain {

// Applies a share of the last substep's forces between nodes to the velocities, and leaves it in the multipliers.
void Constraints::spreadForces(const LineSolve& warp, const LineSolve& weft, double share) noexcept {
  forEachBlock([&](int block) {
    for (int i = 0; i < pattern_.grid.rows; ++i) {
      const std::size_t first = pattern_.grid.row(i) + static_cast<std::size_t>(block) * kLane;
      for (std::size_t n = first; n < first + kLane; ++n) warp_.multiplier[n] = share * last_warp_[n];
    }
    pullWarp(warp, block, warp_.multiplier);
  });
  if (weft_pulls_) {
    for (std::size_t n = 0; n < pattern_.grid.size(); ++n) change_[n] = share * last_weft_[n];
    for (int i = 0; i < pattern_.grid.rows; ++i) pullWeft(weft, i, change_);
  }
  for (RowMaker* maker : makers_) maker->spread(share, inertia_.masses(), warp.value);
}

void Constraints::addPulls(const Field3& position, double share, Field3& velocity) noexcept {
  setWarpDirections(pattern_.grid, position, warp_.direction);
  if (stringsPull()) setWeftDirectionsAt(position);
  spreadForces({pattern_, inertia_.masses(), warp_, velocity}, {pattern_, inertia_.masses(), weft_, velocity}, share);
}

// Back to what the round began with; contacts forget what they took up in it.
void Constraints::undoRound(Field3& velocity) noexcept {
  for (Row& row : rows_) row.change = -row.change;
  for (RowMaker* maker : makers_) maker->moveBy(rows_, inertia_.masses(), velocity);
  velocity = best_.position;
}

void Constraints::project(const Field3& position, double share, const EnergyAccount& account, double most,
                          Field3& velocity) noexcept {
  setWarpDirections(pattern_.grid, position, warp_.direction);

  const LineSolve warp{pattern_, inertia_.masses(), warp_, velocity, guide_};
  const LineSolve weft{pattern_, inertia_.masses(), weft_, velocity, guide_};
  const bool presses = anyPushes(contacts_.all());
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
  if (share > 0.0) spreadForces(warp, weft, share);
  settle();
  solveRods();
  if (alone) return;
  net_.begin(position, inertia_.masses(), guide_);
  const int rounds = presses ? kContactRounds : kVelocityRounds;
  double first_rate = 0.0;
  for (int round = 0; round < rounds; ++round) {
    double rate = worstOfRows([&](int i) { return measureWeftRates(weft, i, violation_, active_); });
    for (RowMaker* maker : makers_) rate = std::max(rate, maker->measureRates(velocity));
    if (round == 0) first_rate = rate;
    if (rate == 0.0 || (round > 0 && rate <= kVelocityReduction * first_rate)) break;
    best_.position = velocity;
    makeRows(velocity, true);
    net_.solve(violation_, active_, rows_,
               {rate * middle_rest_, kVelocityDamping, kVelocityReduction, kVelocityIterations}, change_);
    for (int i = 0; i < pattern_.grid.rows; ++i) pullWeft(weft, i, change_);
    for (RowMaker* maker : makers_) maker->moveBy(rows_, inertia_.masses(), velocity);
    settle();
    solveRods();
    // Where taut rods leave nodes hardly any mobility, rates were seen to grow with every round, by up to 2400 times.
    if (account.exceeds(most, velocity)) {
      undoRound(velocity);
      break;
    }
  }
  if (weft_pulls_) std::fill(weft_.multiplier.begin(), weft_.multiplier.end(), 0.0);
}

}  // namespace curtain
