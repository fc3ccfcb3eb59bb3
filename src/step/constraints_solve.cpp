// SPDX-License-Identifier: BSD-3-Clause
//
// The parts of a solve: rods, strings, rows.
#include <array>
#include <cmath>

#include "cloth/wide.h"
#include "step/constants.h"
#include "step/constraints.h"

namespace curtain {
namespace {

// Sum of |multiplier| length^2. Summed by lanes: the order does not depend on the register width.
CURTAIN_WIDE double pullsTimesLengths(const Field& multiplier, const Field& length) noexcept {
  std::array<double, kLane> sums{};
  for (std::size_t n = 0; n < length.size(); n += kLane) {
#pragma omp simd
    for (std::size_t l = 0; l < kLane; ++l) sums[l] += std::abs(multiplier[n + l]) * length[n + l] * length[n + l];
  }
  double sum = 0.0;
  for (const double lane : sums) sum += lane;
  return sum;
}

}  // namespace

// Newton on one block of columns; skipped when its rods are within leave_alone.
Constraints::RodsProgress Constraints::solveBlock(const LineSolve& warp, const RodsAim& aim, int block) noexcept {
  RodsProgress progress;
  if (aim.leave_alone > 0.0) {
    const double residual = warpResidual(warp, block);
    progress.first_residual = residual;
    if (residual <= aim.leave_alone) return progress;
  }
  for (int iteration = 0; iteration < kNewtonIterations; ++iteration) {
    if (aim.follow) setWarpDirections(pattern_.grid, block, next, warp_.direction);
    const LineOutcome outcome = warpNewton(warp, scratch_, block);
    if (iteration == 0) progress.first_residual = std::max(progress.first_residual, outcome.residual);
    if (!outcome.sound || !(outcome.residual < aim.max_residual)) break;
    if (outcome.residual <= aim.stop) return progress;
  }
  progress.converged = false;
  return progress;
}

Constraints::RodsProgress Constraints::solveRods(const RodsAim& aim) noexcept {
  const LineSolve warp = rods();
  forEachBlock([&](int block) { block_progress_[static_cast<std::size_t>(block)] = solveBlock(warp, aim, block); });
  RodsProgress all;
  for (const RodsProgress& block : block_progress_) {
    all.converged = all.converged && block.converged;
    all.first_residual = std::max(all.first_residual, block.first_residual);
  }
  settleGuide();
  return all;
}

double Constraints::rodsResidual() noexcept {
  const LineSolve warp = rods();
  double worst = 0.0;
  for (int block = 0; block < warpBlockCount(pattern_.grid); ++block) {
    worst = std::max(worst, warpResidual(warp, block));
  }
  return worst;
}

double Constraints::checkStrings(bool closely) noexcept {
  measured_ = false;
  if (closely) return measureStrings();
  const double longest = worstOfRows([&](int i) { return weftSquare(pattern_.grid, i, next, free_per_square_); });
  return std::max(longest > 1.0 ? 0.5 * (longest - 1.0) : 0.0, distances_.measure(inertia_.inverse(), next));
}

double Constraints::measureStrings() noexcept {
  const LineSolve weft = wefts();
  const double worst = worstOfRows([&](int i) { return measureWeft(weft, i, {violation_, active_, compliance_}); });
  measured_ = true;
  return std::max(worst, distances_.measure(inertia_.inverse(), next));
}

void Constraints::setWeftDirectionsAt(const Field3& position) noexcept {
  worstOfRows([&](int i) {
    setWeftDirections(pattern_.grid, i, position, weft_.direction);
    return 0.0;
  });
  distances_.setDirections(position);
}

void Constraints::followDirections() noexcept {
  forEachBlock([&](int block) { setWarpDirections(pattern_.grid, block, next, warp_.direction); });
  setWeftDirectionsAt(next);
  if (guide_ != nullptr) guide_->followDirections();
  net_.begin(next, inertia_.inverse(), guided());
  directions_set_ = net_ready_ = true;
}

void Constraints::setDirections(const Field3& start) noexcept {
  if (net_ready_) return;
  if (!directions_set_) setWeftDirectionsAt(start);
  net_.begin(start, inertia_.inverse(), guided());
  directions_set_ = net_ready_ = true;
}

// The order of the rows is that of all sums over them: contacts come first.
void Constraints::makeRows(const Field3& value, bool rates) noexcept {
  rows_.clear();
  for (auto maker = makers_.rbegin(); maker != makers_.rend(); ++maker) {
    (*maker)->first_row = rows_.size();
    (*maker)->addRows(value, rates, rows_);
    (*maker)->end_row = rows_.size();
  }
}

void Constraints::solveNet(const NetAim& aim) noexcept {
  if (!measured_) measureStrings();
  measured_ = false;
  const Field* const multiplier = aim.newton ? &weft_.multiplier : nullptr;
  makeRows(next, false);
  net_.solve(violation_, active_, rows_,
             {aim.residual * middle_rest_, aim.damping, aim.enough, kGradientIterations, multiplier, &compliance_},
             change_);
  const double share = !rows_.empty() ? applyTogether() : applyStringChange(aim.residual);
  for (RowMaker* maker : makers_) maker->applyChange(rows_, share, inertia_.inverse(), next);
  settleGuide();
}

// Moves nodes by the changes of the strings, or by a share of them if they are large. Returns the share.
double Constraints::applyStringChange(double residual) noexcept {
  const LineSolve weft = wefts();
  const double move =
      residual > kWatchMoves ? std::sqrt(worstOfRows([&](int i) { return weftMoveSquared(weft, i, change_); })) : 0.0;
  const double share = move > kLargestMove ? kLargestMove / move : 1.0;
  if (share != 1.0) {
    for (double& change : change_) change *= share;
  }
  worstOfRows([&](int i) {
    applyWeftChange(weft_, pattern_.grid, i, change_);
    pullWeft(weft, i, change_);
    return 0.0;
  });
  return share;
}

double Constraints::merit(double rods_lack) noexcept {
  if (!measured_) measureStrings();
  double sum = static_cast<double>(pattern_.grid.nodeCount()) * rods_lack * rods_lack;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    const double relative = active_[n] * violation_[n] * pattern_.weft_per_square[n];
    sum += relative * relative;
  }
  for (RowMaker* maker : makers_) maker->addSquares(next, sum);
  return sum;
}

double Constraints::canHold(double h, double tolerance, double contact_tolerance) const noexcept {
  double links = pullsTimesLengths(warp_.multiplier, pattern_.warp_rest), touch = 0.0;
  if (directions_set_) links += pullsTimesLengths(weft_.multiplier, pattern_.weft_rest);
  for (const DistanceRow& row : distances_.all()) links += row.multiplier * row.length * row.length;
  for (const Contact& contact : contacts_.all()) touch += std::abs(contact.push);
  return 2.0 * (links * tolerance + touch * contact_tolerance) / (h * h);
}

double Constraints::heldBeyond(const Field3& start, double h, double tolerance) const noexcept {
  double sum = 0.0;
  const auto add = [&](std::size_t a, std::size_t b, double length, double multiplier) {
    const double off = 0.5 * std::abs((start.at(a) - start.at(b)).squaredNorm() / (length * length) - 1.0);
    if (off > tolerance) sum += std::abs(multiplier) * off * length * length;
  };
  forEachLink(pattern_, [&](std::size_t n, std::size_t other, double rest, bool rod) {
    add(n, other, rest, (rod ? warp_ : weft_).multiplier[n]);
  });
  for (const DistanceRow& row : distances_.all()) add(row.node, row.other, row.length, row.multiplier);
  return sum / (h * h);
}

void Constraints::saveIterate() {
  best_.position = next;
  best_.warp = warp_.multiplier;
  best_.weft = weft_.multiplier;
  for (RowMaker* maker : makers_) maker->saveIterate();
}

void Constraints::restoreIterate() noexcept {
  next = best_.position;
  warp_.multiplier = best_.warp;
  weft_.multiplier = best_.weft;
  for (RowMaker* maker : makers_) maker->restoreIterate();
  measured_ = false;
}

}  // namespace curtain
