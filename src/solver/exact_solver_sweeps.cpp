// SPDX-License-Identifier: BSD-3-Clause
//
// The sweeps of a substep: rods, then all taut strings and contacts at once, until links and contacts are within their tolerances.
#include <algorithm>
#include <cmath>

#include "solver/constants.h"
#include "solver/exact_solver.h"

namespace curtain {

// Newton on one block of columns until an iteration starts with a residual of at most stop. A block whose rods are within
// leave_alone already is not touched. begun: begin() has made the first iteration.
ExactSolver::WarpProgress ExactSolver::solveBlock(bool follow, const LineSolve& warp, int block, double stop,
                                                  double leave_alone, double most_residual, bool begun) noexcept {
  WarpProgress progress;
  if (leave_alone > 0.0) {
    const double residual = warpResidual(warp, block);
    progress.first_residual = residual;
    if (residual <= leave_alone) return progress;
  }
  for (int iteration = 0; iteration < kNewtonIterations; ++iteration) {
    if (follow) setWarpDirections(pattern_.grid, block, next_, warp_.direction);
    const LineOutcome outcome =
        begun && iteration == 0 ? block_begun_[static_cast<std::size_t>(block)] : warpNewton(warp, scratch_, block);
    if (iteration == 0) progress.first_residual = std::max(progress.first_residual, outcome.residual);
    if (!outcome.sound || !(outcome.residual < most_residual)) break;
    if (outcome.residual <= stop) {
      progress.last_residual = outcome.residual;
      return progress;
    }
  }
  progress.converged = false;
  return progress;
}

ExactSolver::WarpProgress ExactSolver::solveWarp(bool follow, const LineSolve& warp, double stop,
                                                 double leave_alone, double most_residual, bool begun) noexcept {
  forEachBlock([&](int block) {
    block_progress_[static_cast<std::size_t>(block)] = solveBlock(follow, warp, block, stop, leave_alone, most_residual, begun);
  });
  WarpProgress all;
  for (const WarpProgress& block : block_progress_) {
    all.converged = all.converged && block.converged;
    all.first_residual = std::max(all.first_residual, block.first_residual);
    all.last_residual = std::max(all.last_residual, block.last_residual);
  }
  return all;
}

double ExactSolver::weftResidualNow(const LineSolve& weft) noexcept {
  return worstOfRows([&](int i) { return weftResidual(weft, i); });
}

// The same where no string pulls.
double ExactSolver::slackResidual() noexcept {
  const double longest = worstOfRows([&](int i) { return weftSquare(pattern_.grid, i, held_.movingSpan(), next_, free_per_square_); });
  return longest > 1.0 ? 0.5 * (longest - 1.0) : 0.0;
}

double ExactSolver::warpResidualNow(const LineSolve& warp) noexcept {
  double worst = 0.0;
  for (int block = 0; block < warpBlockCount(pattern_.grid); ++block) {
    if (!held_.skips(block)) worst = std::max(worst, warpResidual(warp, block));
  }
  return worst;
}

bool ExactSolver::withinTolerance(const LineSolve& warp, const LineSolve& weft, double tolerance) noexcept {
  const double allowed = tolerance / kInnerTolerance;
  return warpResidualNow(warp) <= allowed && weftResidualNow(weft) <= allowed;
}

// Directions of all links are those of the positions as they are now.
void ExactSolver::followDirections() noexcept {
  forEachBlock([&](int block) { setWarpDirections(pattern_.grid, block, next_, warp_.direction); });
  setAllWeftDirections(next_);
  net_.begin(next_, inertia_.inverse(), held_.movingSpan());
}

void ExactSolver::setAllWeftDirections(const Field3& position) noexcept {
  worstOfRows([&](int i) {
    setWeftDirections(pattern_.grid, i, held_.movingSpan(), position, weft_.direction);
    return 0.0;
  });
}

// All taut links of the weft and all contacts, with the rods' answer in view. The nodes move by their part of it; the rods'
// own solve comes next.
void ExactSolver::solveNet(const LineSolve& weft, Contacts* contacts, double residual, const WeftStep& step) noexcept {
  if (!measured_) worstOfRows([&](int i) { return measureWeft(weft, i, violation_, active_); });
  net_.solve(violation_, active_, {contacts, &next_, false},
             {residual * middle_rest_, step.damping, step.enough, kGradientIterations}, change_);
  const double move = residual > kWatchMoves
                          ? std::sqrt(worstOfRows([&](int i) { return weftMoveSquared(weft, i, change_); }))
                          : 0.0;
  const double share = move > kLargestMove ? kLargestMove / move : 1.0;
  if (share != 1.0) {
    for (double& change : change_) change *= share;
  }
  worstOfRows([&](int i) {
    takeUpWeft(weft_, pattern_.grid, i, change_);
    pullWeft(weft, i, change_);
    return 0.0;
  });
  if (contacts == nullptr) return;
  net_.forEachContactChange([&](std::uint32_t index, double push, const Vec3& slide) {
    takeUpContact(inertia_.inverse(), share * push, share * slide, (*contacts)[index], next_);
  });
}

void ExactSolver::keepIterate(double residual, const Contacts* contacts) {
  best_.residual = residual;
  best_.position = next_;
  best_.warp = warp_.multiplier;
  best_.weft = weft_.multiplier;
  if (contacts != nullptr) best_.contacts = *contacts;
}

void ExactSolver::goBack(Contacts* contacts) noexcept {
  next_ = best_.position;
  warp_.multiplier = best_.warp;
  weft_.multiplier = best_.weft;
  if (contacts != nullptr) *contacts = best_.contacts;
  measured_ = false;
}

// What a sweep must make smaller: the sum of the squares of what links and contacts lack, over a link. A damped step makes it smaller if
// it is short enough, where the largest may stand on a plateau. rods_lack: of every rod, where their own solve has not converged.
double ExactSolver::meritOf(const Contacts* contacts, double rods_lack) noexcept {
  const LineSolve weft{pattern_, inertia_.inverse(), weft_, next_, held_.movingSpan()};
  if (!measured_) worstOfRows([&](int i) { return measureWeft(weft, i, violation_, active_); });
  measured_ = true;
  double sum = static_cast<double>(pattern_.grid.nodeCount()) * rods_lack * rods_lack;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    const double relative = violation_[n] * pattern_.weft_per_square[n];
    sum += relative * relative;
  }
  for (std::size_t k = 0; contacts != nullptr && k < contacts->size(); ++k) {
    const double relative = contactViolation((*contacts)[k], next_) / middle_rest_;
    sum += relative * relative;
  }
  return sum;
}

ExactSolver::Progress ExactSolver::solveConstraints(const SubstepPlan& plan, const Field3& start, double weight_way,
                                                    Contacts* contacts, StageClock& clock) noexcept {
  const LineSolve warp{pattern_, inertia_.inverse(), warp_, next_, held_.movingSpan()};
  const LineSolve weft{pattern_, inertia_.inverse(), weft_, next_, held_.movingSpan()};
  const bool touches = contacts != nullptr && !contacts->empty();
  // What the last resort leaves the far shorter steps after it would have to mend at once: by a blow.
  const double share_for_weight =
      plan.last_resort   ? kLastResortShare
      : weight_way > 0.0 ? std::clamp(kShareOfWeight * weight_way / (middle_rest_ * tolerance_), kLeastShare, 1.0)
                         : 1.0;
  Progress progress;
  bool follow = plan.scheme != Scheme::kLeapfrog || plan.last_resort;
  bool net_ready = false;
  double window_residual = std::numeric_limits<double>::infinity();
  double last_residual = window_residual;
  double touch = 0.0;
  double caution = 1.0;
  best_.residual = best_.merit = std::numeric_limits<double>::infinity();
  while (progress.sweeps < max_sweeps_) {
    const bool first = progress.sweeps == 0;
    double strict = 1.0;
    if (progress.sweeps < kStrictSweeps) {
      if (touches) strict = kStrictShare;
      if (!touches && (weft_pulls_ || directions_set_)) strict = share_for_weight;
    }
    const double tolerance = strict * tolerance_;
    const double contact_tolerance = strict * contact_tolerance_;
    const double stop = plan.precise ? kPreciseStop : first && !weft_pulls_ ? kNewtonStop : kNewtonStopLater;
    const WarpProgress rods = solveWarp(follow, warp, stop, first ? 0.0 : kLeaveAlone * tolerance,
                                        plan.last_resort ? kInfinite : kDiverged, first && newton_begun_);
    clock.lap(Stage::kWarp);
    if (!rods.converged && !plan.last_resort) return progress;
    ++progress.sweeps;
    const double rubbed =
        touches && progress.sweeps <= kRubSweeps ? rubContacts(inertia_.inverse(), *contacts, next_) : 0.0;
    touch = touches ? contactResidual(*contacts, next_) : 0.0;
    clock.lap(Stage::kContact);
    measured_ = weft_pulls_ || !first;
    const double strings = measured_ ? worstOfRows([&](int i) { return measureWeft(weft, i, violation_, active_); })
                                     : slackResidual();
    const double share = first && !plan.last_resort ? kFirstSweepShare : 1.0;
    if (rods.converged && strings <= share * tolerance && touch <= share * contact_tolerance && rubbed <= kRubShare * contact_tolerance &&
        ((rods.last_residual * inertia_.dampingSpread() <= sure_stop_ && rubbed == 0.0) ||
         warpResidualNow(warp) <= tolerance)) {
      progress.settled = true;
      clock.lap(Stage::kWeft);
      return progress;
    }
    double residual = std::max(strings, touch / middle_rest_);
    if (!std::isfinite(residual)) break;
    bool undone = false;
    if (plan.last_resort) {
      const double merit = meritOf(contacts, rods.converged ? 0.0 : warpResidualNow(warp));
      if (merit < best_.merit) {
        best_.merit = merit;
        keepIterate(residual, contacts);
        caution = std::max(1.0, caution / kLessCaution);
      } else if (std::isfinite(best_.merit)) {
        goBack(contacts);
        residual = best_.residual;
        caution *= kMoreCaution;
        undone = true;
        if (caution * kDampingPerResidual * residual > kMostDamping) break;
      }
    } else {
      // A sweep that has not brought the links nearer went too far where hardly anything holds: the next one is damped more.
      caution = residual > (touches ? kPoorTouchingSweep : kPoorSweep) * last_residual
                    ? std::min(kMostCaution, caution * kMoreCaution)
                    : std::max(1.0, caution / kLessCaution);
    }
    last_residual = residual;
    if (undone || strings > (first && !plan.last_resort ? kFirstSweepShare : kLeaveAlone) * tolerance ||
        touch > (first && !plan.last_resort ? kFirstSweepShare : kLeaveAlone) * contact_tolerance) {
      // What the first sweep leaves is corrected along the present directions, all of it: forces along the directions at
      // the start may have no solution at all where a flat net shears, and a correction along one set of directions taken
      // back along another is a force that does work. Contact settles better along given ones.
      follow = follow || !touches;
      if (follow) {
        followDirections();
        directions_set_ = net_ready = true;
      } else if (!net_ready) {
        if (!directions_set_) setAllWeftDirections(start);
        directions_set_ = net_ready = true;
        net_.begin(start, inertia_.inverse(), held_.movingSpan());
      }
      const double least = follow ? kFollowReduction : kLeastReduction;
      solveNet(weft, contacts, residual, {std::clamp(kReductionShare * tolerance / residual, least, kMostReduction),
                                          std::min(plan.last_resort ? kMostDamping : kLargestDamping, caution * kDampingPerResidual * residual)});
    }
    clock.lap(Stage::kWeft);
    if (clock.late()) {
      progress.late = true;
      break;
    }
    if (plan.last_resort) continue;
    if (progress.sweeps % (touches ? kContactStallWindow : kStallWindow) == 0) {
      const double factor = touches ? kContactStallFactor : kStallFactor;
      const double left = std::max(rods.first_residual, residual);
      if (!(left < factor * window_residual)) break;
      window_residual = left;
    }
  }
  if (plan.last_resort && std::isfinite(best_.merit)) {
    goBack(contacts);
    if (touches) touch = contactResidual(*contacts, next_, false);
  }
  // Slower than it should, but what was asked for may be reached all the same.
  progress.settled = touch <= contact_tolerance_ && withinTolerance(warp, weft, tolerance_);
  progress.found = true;
  progress.left_over = true;
  return progress;
}

}  // namespace curtain
