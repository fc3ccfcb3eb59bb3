// SPDX-License-Identifier: BSD-3-Clause
#include "solver/exact_solver.h"

#include <algorithm>
#include <cmath>

#include "forces/air_damping.h"

namespace curtain {
namespace {

// The tolerance inside: what the last half-sweep stirs up again must still fit below the user's.
constexpr double kInnerTolerance = 0.4;
// What is left over at the end of a substep becomes a velocity of (left over) / h, so shorter substeps leave less: the
// tolerance goes down with h below this one [s].
constexpr double kToleranceStep = 0.004;
// Share of the tolerance below which a row of the weft is not touched in a substep's first sweep. Far smaller than 1:
// a link left to drift through the tolerance and then pulled back at once would be kicked.
constexpr double kFirstSweepShare = 1e-4;
// Newton converges quadratically: an iteration that starts this close ends near the square of it, times a factor that
// grows with the column's height.
constexpr double kNewtonStop = 1e-4;
// In later sweeps the next one looks again, so a start this close is left at that.
constexpr double kNewtonStopLater = 1e-2;
constexpr int kNewtonIterations = 12;
// Share of the tolerance below which a block of columns is not solved again in a later sweep.
constexpr double kLeaveAlone = 0.1;
// A relative violation beyond this is a step that failed, not one that converges slowly.
constexpr double kDiverged = 4.0;
// Alternating exact solves of two blocks gain a factor rho a sweep; taking the weft this much further gains more where
// rho is near 1 (sheared cloth), and is not worth it where a few sweeps do. Measured: 0.8 diverges at times.
constexpr int kPlainSweeps = 3;
constexpr double kOverRelaxation = 0.5;
// Sweeps that must at least bring this improvement, or the alternation has stalled.
constexpr int kStallWindow = 16;
constexpr double kStallFactor = 0.9;
// Alternations of the linear velocity projection; each gains about cos^2 of the angle between warp and weft.
constexpr int kVelocitySweeps = 6;

double smallestRest(const ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  double smallest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      if (i > 0) smallest = std::min(smallest, pattern.warp_rest[grid.index(i, j)]);
      if (j > 0 || grid.closed) smallest = std::min(smallest, pattern.weft_rest[grid.index(i, j)]);
    }
  }
  return smallest;
}

bool allFinite(const Field3& field) {
  double sum = 0.0;  // 0 * x is NaN for NaN and infinity alike
  for (const Field* component : {&field.x, &field.y, &field.z}) {
    const double* const p = component->data();
    const std::size_t size = component->size();
    for (std::size_t n = 0; n < size; ++n) sum += 0.0 * p[n];
  }
  return sum == 0.0;
}

}  // namespace

ExactSolver::ExactSolver(const ClothPattern& pattern, double stretch_tolerance, int max_sweeps)
    : pattern_(pattern),
      tolerance_(kInnerTolerance * stretch_tolerance),
      contact_tolerance_(kInnerTolerance * stretch_tolerance * smallestRest(pattern)),
      max_sweeps_(max_sweeps),
      weft_solver_(pattern.grid),
      last_warp_(pattern.grid.size() + static_cast<std::size_t>(pattern.grid.stride), 0.0),
      last_weft_(last_warp_),
      damped_inertia_(pattern.inverse_mass) {
  scratch_.assign(pattern.grid);
  warp_.assign(pattern.grid);
  weft_.assign(pattern.grid);
  next_.assign(pattern.grid.size(), 0.0);
}

void ExactSolver::reset() noexcept {
  std::fill(last_warp_.begin(), last_warp_.end(), 0.0);
  std::fill(last_weft_.begin(), last_weft_.end(), 0.0);
  last_scale_ = 0.0;
  scratch_.assign(pattern_.grid);
}

void ExactSolver::predict(const NodeForces& forces, double kick, double h, const ClothState& state) noexcept {
  const std::size_t size = pattern_.grid.size();
  const double* const w = pattern_.inverse_mass.data();
  if (forces.has_damping) {
    for (std::size_t n = 0; n < size; ++n) damped_inertia_[n] = dampedStep(forces.damping[n], w[n], kick).gain * w[n];
  }
  inertia_ = forces.has_damping ? &damped_inertia_ : &pattern_.inverse_mass;
  const double* const gain = inertia_->data();
  const double* const c = forces.has_damping ? forces.damping.data() : nullptr;
  const auto component = [&](const Field& force, const Field& velocity, const Field& position, Field& next) {
    const double* const f = force.data();
    const double* const v = velocity.data();
    const double* const x = position.data();
    double* const out = next.data();
    if (c != nullptr) {
      for (std::size_t n = 0; n < size; ++n) {
        out[n] = x[n] + h * (dampedStep(c[n], w[n], kick).keep * v[n] + kick * gain[n] * f[n]);
      }
    } else {
#pragma omp simd
      for (std::size_t n = 0; n < size; ++n) out[n] = x[n] + h * (v[n] + kick * gain[n] * f[n]);
    }
  };
  component(forces.force.x, state.velocity.x, state.position.x, next_.x);
  component(forces.force.y, state.velocity.y, state.position.y, next_.y);
  component(forces.force.z, state.velocity.z, state.position.z, next_.z);
}

// Multipliers grow with h * kick at the same tensions. The implicit scheme starts from none: what acts along the
// directions at the start of the step is an explicit part, and unstable at the steps that scheme is for (a quarter of the
// tension was already too much at 100 rows).
void ExactSolver::warmStart(Scheme scheme, double scale, const LineSolve& warp, const LineSolve& weft) noexcept {
  const double ratio = last_scale_ > 0.0 && scheme == Scheme::kLeapfrog ? scale / last_scale_ : 0.0;
  const std::size_t size = pattern_.grid.size();
  for (std::size_t n = 0; n < size; ++n) warp_.multiplier[n] = ratio * last_warp_[n];
  for (std::size_t n = 0; n < size; ++n) weft_.multiplier[n] = ratio * last_weft_[n];
  if (ratio == 0.0) return;
  applyWarpMultipliers(warp);
  WeftSolver::applyMultipliers(weft);
}

// Newton on one block of columns until an iteration starts with a residual of at most stop.
bool ExactSolver::solveBlock(Scheme scheme, const LineSolve& warp, int block, double stop, WarpProgress& progress) noexcept {
  for (int iteration = 0; iteration < kNewtonIterations; ++iteration) {
    if (scheme == Scheme::kImplicit) setWarpDirections(pattern_.grid, block, next_, warp_.direction);
    const LineOutcome outcome = warpNewton(warp, scratch_, block);
    if (iteration == 0) progress.first_residual = std::max(progress.first_residual, outcome.residual);
    if (!outcome.sound || !(outcome.residual < kDiverged)) return false;
    if (outcome.residual <= stop) {
      progress.last_residual = std::max(progress.last_residual, outcome.residual);
      return true;
    }
  }
  return false;
}

// All blocks; in sweeps after the first, those whose rods are in order are left alone.
ExactSolver::WarpProgress ExactSolver::solveWarp(Scheme scheme, const LineSolve& warp, double tolerance,
                                                bool first_sweep) noexcept {
  WarpProgress progress;
  progress.converged = true;
  const double stop = first_sweep ? kNewtonStop : kNewtonStopLater;
  for (int block = 0; block < warpBlockCount(pattern_.grid); ++block) {
    if (!first_sweep) {
      const double residual = warpResidual(warp, block);
      if (residual <= kLeaveAlone * tolerance) {
        progress.first_residual = std::max(progress.first_residual, residual);
        continue;
      }
    }
    if (!solveBlock(scheme, warp, block, stop, progress)) progress.converged = false;
  }
  return progress;
}

// Looks at every link as it is now.
bool ExactSolver::withinTolerance(const LineSolve& warp, const LineSolve& weft, double tolerance) noexcept {
  const double allowed = tolerance / kInnerTolerance;
  for (int block = 0; block < warpBlockCount(pattern_.grid); ++block) {
    if (!(warpResidual(warp, block) <= allowed)) return false;
  }
  return weft_solver_.residual(weft) <= allowed;
}

ExactSolver::Progress ExactSolver::solveConstraints(Scheme scheme, double h, bool must_accept,
                                                    PositionConstraints* constraints, StageClock& clock) noexcept {
  const double tolerance = tolerance_ * std::min(1.0, h / kToleranceStep);
  const LineSolve warp{pattern_, *inertia_, warp_, next_};
  const LineSolve weft{pattern_, *inertia_, weft_, next_};
  Progress progress;
  double window_residual = std::numeric_limits<double>::infinity();
  bool rest_solved = false;
  double contact_move = 0.0;
  while (progress.sweeps < max_sweeps_) {
    const WarpProgress rods = solveWarp(scheme, warp, tolerance, progress.sweeps == 0);
    clock.lap(Stage::kWarp);
    if (!rods.converged && !must_accept) return progress;
    ++progress.sweeps;
    // The rest had just been solved and the rods were still found in order.
    if (rest_solved && rods.converged && rods.first_residual <= tolerance && withinTolerance(warp, weft, tolerance)) {
      progress.settled = true;
      return progress;
    }
    const bool slow = progress.sweeps > kPlainSweeps && progress.sweeps < max_sweeps_;
    const LineOutcome weft_outcome =
        weft_solver_.solve(weft, tolerance, progress.sweeps == 1 ? kFirstSweepShare * tolerance : tolerance,
                           scheme == Scheme::kImplicit, slow ? kOverRelaxation : 0.0);
    clock.lap(Stage::kWeft);
    contact_move = 0.0;
    if (constraints != nullptr) {
      contact_move = constraints->project(next_);
      clock.lap(Stage::kContact);
    }
    rest_solved = weft_outcome.solved && contact_move <= contact_tolerance_;
    if (rods.converged && rods.last_residual <= kNewtonStop && weft_outcome.residual <= tolerance &&
        contact_move <= contact_tolerance_ && withinTolerance(warp, weft, tolerance)) {
      progress.settled = true;
      return progress;
    }
    if (progress.sweeps % kStallWindow == 0) {
      const double residual = std::max(rods.first_residual, weft_outcome.residual);
      const bool stalled = !(residual < kStallFactor * window_residual);
      if (stalled && (!must_accept || withinTolerance(warp, weft, tolerance_))) break;
      window_residual = residual;
    }
  }
  // Slower than it should, but what was asked for may be reached all the same.
  progress.settled = withinTolerance(warp, weft, tolerance_) && contact_move <= contact_tolerance_;
  progress.left_over = true;
  return progress;
}

// Gershgorin bound on the transverse oscillations of the taut net: omega^2 <= max_i 2 w_i sum |s_k| / (h kick).
double ExactSolver::omegaSquared(double scale) const noexcept {
  const Grid& grid = pattern_.grid;
  const auto stride = static_cast<std::size_t>(grid.stride);
  double worst = 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      const std::size_t right = j + 1 < grid.columns ? n + 1 : grid.row(i);
      const double right_pull = j + 1 < grid.columns || grid.closed ? weft_.multiplier[right] : 0.0;
      const double sum = std::abs(warp_.multiplier[n]) + std::abs(warp_.multiplier[n + stride]) +
                         weft_.multiplier[n] + right_pull;
      worst = std::max(worst, sum * pattern_.inverse_mass[n]);
    }
  }
  return 2.0 * worst / scale;
}

void ExactSolver::commit(double h, double velocity_age, ClothState& state) noexcept {
  const std::size_t size = pattern_.grid.size();
  const double per_h = 1.0 / h;
  const auto component = [&](const Field& next, const Field& position, Field& velocity) {
    const double* const to = next.data();
    const double* const from = position.data();
    double* const v = velocity.data();
#pragma omp simd
    for (std::size_t n = 0; n < size; ++n) v[n] = (to[n] - from[n]) * per_h;
  };
  component(next_.x, state.position.x, state.velocity.x);
  component(next_.y, state.position.y, state.velocity.y);
  component(next_.z, state.position.z, state.velocity.z);
  std::swap(state.position, next_);
  std::swap(last_warp_, warp_.multiplier);
  std::swap(last_weft_, weft_.multiplier);
  state.velocity_age = velocity_age;
}

SubstepOutcome ExactSolver::substep(Scheme scheme, const NodeForces& forces, double h, bool must_accept,
                                    PositionConstraints* constraints, ClothState& state, StageClock& clock) noexcept {
  const bool leapfrog = scheme == Scheme::kLeapfrog;
  const double kick = state.velocity_age + (leapfrog ? 0.5 * h : h);
  const double scale = h * kick;
  predict(forces, kick, h, state);
  setWarpDirections(pattern_.grid, state.position, warp_.direction);
  WeftSolver::setDirections(pattern_.grid, state.position, weft_.direction);
  warmStart(scheme, scale, {pattern_, *inertia_, warp_, next_}, {pattern_, *inertia_, weft_, next_});
  clock.lap(Stage::kPredict);
  if (constraints != nullptr) {
    constraints->begin(pattern_, state.position, next_, h);
    clock.lap(Stage::kContact);
  }
  const Progress progress = solveConstraints(scheme, h, must_accept, constraints, clock);
  SubstepOutcome outcome;
  outcome.sweeps = progress.sweeps;
  outcome.settled = progress.settled;
  outcome.accepted = (progress.settled || must_accept) && allFinite(next_);
  if (outcome.accepted) {
    outcome.omega_squared = omegaSquared(scale);
    outcome.scale = last_scale_ = scale;
    commit(h, leapfrog ? 0.5 * h : 0.0, state);
    // The way such a substep has gone is not all motion: what pulls its links further is taken out.
    if (progress.left_over) projectVelocity(state.position, constraints, state.velocity);
  }
  clock.lap(Stage::kFinish);
  return outcome;
}

void ExactSolver::currentVelocities(const ClothState& state, const NodeForces& forces,
                                    PositionConstraints* constraints, Field3& out) noexcept {
  const double age = state.velocity_age;
  const std::size_t size = pattern_.grid.size();
  for (std::size_t n = 0; n < size; ++n) {
    const double w = pattern_.inverse_mass[n];
    const DampedStep step = forces.has_damping ? dampedStep(forces.damping[n], w, age) : DampedStep{1.0, 1.0};
    out.set(n, step.keep * state.velocity.at(n) + age * step.gain * w * forces.force.at(n));
  }
  if (age > 0.0) projectVelocity(state.position, constraints, out);
}

// Takes out of the velocities what would change the lengths of rods and of links that pull.
void ExactSolver::projectVelocity(const Field3& position, PositionConstraints* constraints, Field3& out) noexcept {
  setWarpDirections(pattern_.grid, position, warp_.direction);
  WeftSolver::setDirections(pattern_.grid, position, weft_.direction);
  std::copy(last_weft_.begin(), last_weft_.end(), weft_.multiplier.begin());  // which links pull
  const LineSolve warp{pattern_, pattern_.inverse_mass, warp_, out};
  const LineSolve weft{pattern_, pattern_.inverse_mass, weft_, out};
  bool last = false;
  for (int sweep = 0; sweep < kVelocitySweeps && !last; ++sweep) {
    if (weft_solver_.projectVelocity(weft).residual == 0.0 && constraints == nullptr) {
      last = true;
    }
    if (constraints != nullptr) constraints->projectVelocity(out);
    for (int block = 0; block < warpBlockCount(pattern_.grid); ++block) warpProjectVelocity(warp, scratch_, block);
  }
}

}  // namespace curtain
