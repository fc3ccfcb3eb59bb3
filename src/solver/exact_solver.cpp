// SPDX-License-Identifier: BSD-3-Clause
#include "solver/exact_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/constants.h"

namespace curtain {
namespace {

double unevenness(const ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  double shortest = std::numeric_limits<double>::infinity(), longest = 0.0;
  double lightest = shortest, heaviest = 0.0;
  for (int i = 1; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      shortest = std::min(shortest, pattern.warp_rest[n]);
      longest = std::max(longest, pattern.warp_rest[n]);
      lightest = std::min(lightest, pattern.mass[n]);
      heaviest = std::max(heaviest, pattern.mass[n]);
    }
  }
  return longest / shortest * std::max(1.0, heaviest / (kMassesOfEvenCloth * lightest));
}

// Between the shortest and the longest weft link of the top row.
double middleRest(const ClothPattern& pattern) {
  const auto first = pattern.weft_rest.begin() + (pattern.grid.closed ? 0 : 1);
  const auto [shortest, longest] = std::minmax_element(first, pattern.weft_rest.begin() + pattern.grid.columns);
  return 0.5 * (*shortest + *longest);
}

}  // namespace

ExactSolver::ExactSolver(const ClothPattern& pattern, double stretch_tolerance, int max_sweeps, const Workers& workers)
    : pattern_(pattern),
      free_(std::none_of(pattern.pinned.begin(), pattern.pinned.end(), [](std::uint8_t pin) { return pin != 0; })),
      workers_(workers),
      stretch_tolerance_(stretch_tolerance),
      tolerance_(kInnerTolerance * stretch_tolerance),
      contact_tolerance_(kInnerTolerance * stretch_tolerance * shortestLink(pattern)),
      smallest_rest_(shortestLink(pattern)),
      max_sweeps_(max_sweeps),
      sure_stop_(std::sqrt(tolerance_) / (pattern.grid.rows * unevenness(pattern))),
      inertia_(pattern),
      held_(pattern),
      laid_down_(static_cast<std::size_t>(warpBlockCount(pattern.grid)), 0.0),
      skipped_before_(laid_down_.size(), 0),
      net_(pattern, workers),
      middle_rest_(middleRest(pattern)),
      last_resort_(pattern) {
  const std::size_t size = pattern.grid.size();
  const std::size_t links = size + static_cast<std::size_t>(pattern.grid.stride);
  scratch_.assign(pattern.grid);
  warp_.assign(pattern.grid);
  weft_.assign(pattern.grid);
  weft_.most_give = tolerance_;  // with as much for what the solve leaves it is the user's tolerance
  last_warp_.assign(links, 0.0);
  last_weft_.assign(links, 0.0);
  for (Field* field : {&violation_, &active_, &change_}) field->assign(size, 0.0);
  free_per_square_.assign(size, 0.0);
  freeWeft(pattern, pattern.inverse_mass, free_per_square_);
  next_.assign(size, 0.0);
  no_force_.assign(size, 0.0);
  best_.position.assign(size, 0.0);
  best_.warp.assign(links, 0.0);
  best_.weft.assign(links, 0.0);
  for (Field3* field : {&base_.position, &base_.velocity, &older_position_, &older_velocity_}) field->assign(size, 0.0);
  block_begun_.resize(static_cast<std::size_t>(warpBlockCount(pattern.grid)));
  block_motion_.resize(block_begun_.size());
  block_progress_.resize(static_cast<std::size_t>(warpBlockCount(pattern.grid)));
  row_worst_.resize(static_cast<std::size_t>((pattern.grid.rows + kRowsAtOnce - 1) / kRowsAtOnce));
}

void ExactSolver::reset() noexcept {
  std::fill(last_warp_.begin(), last_warp_.end(), 0.0);
  std::fill(last_weft_.begin(), last_weft_.end(), 0.0);
  std::fill(weft_.multiplier.begin(), weft_.multiplier.end(), 0.0);
  inertia_.forget();
  weft_pulls_ = false;
  older_h_ = 0.0;
  single_steps_ = 0;
  net_.reset();
  scratch_.assign(pattern_.grid);
}

void ExactSolver::save(Memory& memory) const {
  memory.warp = last_warp_;
  memory.weft = last_weft_;
  memory.older_position = older_position_;
  memory.older_velocity = older_velocity_;
  memory.tensions = inertia_.tensions();
  memory.older_h = older_h_;
  memory.single_steps = single_steps_;
  memory.weft_pulls = weft_pulls_;
}

void ExactSolver::restore(const Memory& memory) {
  last_warp_ = memory.warp;
  last_weft_ = memory.weft;
  older_position_ = memory.older_position;
  older_velocity_ = memory.older_velocity;
  inertia_.tensions() = memory.tensions;
  older_h_ = memory.older_h;
  single_steps_ = memory.single_steps;
  weft_pulls_ = memory.weft_pulls;
  if (!weft_pulls_) std::fill(weft_.multiplier.begin(), weft_.multiplier.end(), 0.0);  // as begin() relies on
}

// Where the step starts from: leapfrog and implicit, the state itself; bdf2, what its formula makes of the last two
// (variable steps: ratio r = h / h_before; y' = (1+r)^2/(1+2r) y - r^2/(1+2r) y_before + (1+r)/(1+2r) h f).
const ClothState& ExactSolver::setBase(Scheme scheme, double h, const ClothState& state, double& step) noexcept {
  step = h;
  if (scheme != Scheme::kBdf2 || older_h_ == 0.0 || h > kMostGrowth * older_h_) return state;
  const double r = h / older_h_;
  const double change = r * r / (1.0 + 2.0 * r);  // (1+r)^2/(1+2r) is 1 more: what is at rest stays there to the bit
  step = (1.0 + r) / (1.0 + 2.0 * r) * h;
  const auto combine = [&](const Field& y, const Field& older, Field& out) {
    for (std::size_t n = 0; n < y.size(); ++n) out[n] = y[n] + change * (y[n] - older[n]);
  };
  combine(state.position.x, older_position_.x, base_.position.x);
  combine(state.position.y, older_position_.y, base_.position.y);
  combine(state.position.z, older_position_.z, base_.position.z);
  combine(state.velocity.x, older_velocity_.x, base_.velocity.x);
  combine(state.velocity.y, older_velocity_.y, base_.velocity.y);
  combine(state.velocity.z, older_velocity_.z, base_.velocity.z);
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (inertia_.masses()[n] > 0.0) continue;  // pins go where they are told to, whatever they did before
    base_.position.set(n, state.position.at(n) + (h - step) * state.velocity.at(n));
    base_.velocity.set(n, state.velocity.at(n));
  }
  return base_;
}

// Predicts and starts the multipliers where the last substep left them (returns what they change by with the step). Not when forces follow the directions: its
// iteration blows up when the old tensions act along the new directions of rods that have turned much since.
double ExactSolver::begin(const SubstepPlan& plan, const SubstepStart& start, double scale) noexcept {
  const bool warm = plan.scheme == Scheme::kLeapfrog && !plan.last_resort && inertia_.tensions().scale != 0.0;
  const double ratio = warm ? scale / inertia_.tensions().scale : 0.0;
  const LineSolve warp{pattern_, inertia_.inverse(), warp_, next_, held_.movingSpan()};
  const LineSolve weft{pattern_, inertia_.inverse(), weft_, next_, held_.movingSpan()};
  directions_set_ = false;
  newton_begun_ = plan.scheme == Scheme::kLeapfrog && !weft_pulls_;
  forEachBlock([&](int block) {
    if (newton_begun_) {
      const LineOutcome outcome = warpBeginNewton(start, warp, last_warp_, ratio, scratch_, block);
      block_begun_[static_cast<std::size_t>(block)] = outcome;
      warpEndNewton(warp, scratch_, block);
    } else {
      warpBegin(start, warp, last_warp_, ratio, block);
    }
  });
  if (!weft_pulls_) return ratio;  // all multipliers are zero, in weft_ too
  const std::size_t size = pattern_.grid.size();
  for (std::size_t n = 0; n < size; ++n) weft_.multiplier[n] = ratio * last_weft_[n];
  if (ratio == 0.0) return ratio;
  directions_set_ = true;
  worstOfRows([&](int i) {
    setWeftDirections(pattern_.grid, i, held_.movingSpan(), start.state.position, weft_.direction);
    pullWeft(weft, i, weft_.multiplier);
    return 0.0;
  });
  return ratio;
}

}  // namespace curtain
