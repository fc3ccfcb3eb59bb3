// SPDX-License-Identifier: BSD-3-Clause
#include "solver/sweeps.h"

#include <algorithm>
#include <cmath>

#include "solver/constants.h"

namespace curtain {
namespace {

// How unlike rods and nodes are: what one rod's correction may do to another.
double unevenness(const ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  double shortest = kInfinite, longest = 0.0;
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

}  // namespace

SweepDamping::SweepDamping(bool monotone) noexcept
    : largest_(monotone ? kMostDamping : kLargestDamping), most_factor_(monotone ? kInfinite : kMostCaution) {}

void SweepDamping::better() noexcept { factor_ = std::max(1.0, factor_ / kLessCaution); }
void SweepDamping::worse() noexcept { factor_ = std::min(most_factor_, factor_ * kMoreCaution); }

StallWatch::StallWatch(bool touches) noexcept
    : window_(touches ? kContactStallWindow : kStallWindow), factor_(touches ? kContactStallFactor : kStallFactor) {}

bool StallWatch::stalls(int sweeps, double residual) noexcept {
  if (sweeps % window_ != 0) return false;
  const bool improves = residual < factor_ * before_;
  before_ = residual;
  return !improves;
}

Sweeps::Sweeps(const ClothPattern& pattern, Constraints& constraints, const NodeInertia& inertia, double tolerance,
               double contact_tolerance, int most_sweeps)
    : constraints_(constraints),
      inertia_(inertia),
      tolerance_(kInnerTolerance * tolerance),
      contact_tolerance_(kInnerTolerance * contact_tolerance),
      most_sweeps_(most_sweeps),
      sure_stop_(std::sqrt(tolerance_) / (pattern.grid.rows * unevenness(pattern))) {}

Sweeps::Aim Sweeps::aimOf(const SweepTask& task, bool first, bool touches, int sweeps) const noexcept {
  double strict = 1.0;
  if (sweeps < kStrictSweeps && touches) strict = kStrictShare;
  if (sweeps < kStrictSweeps && !touches && (constraints_.weftPulls() || constraints_.stringsAct())) {
    // What the last resort leaves the far shorter steps after it would have to mend at once: by a blow.
    strict = task.last_resort         ? kLastResortShare
             : task.weight_path > 0.0 ? std::clamp(kShareOfWeight * task.weight_path / (constraints_.middleRest() * tolerance_), kLeastShare, 1.0)
                                      : 1.0;
  }
  const bool cautious = first && !task.last_resort;
  const double newton = task.precise ? kPreciseStop : first && !constraints_.weftPulls() ? kNewtonStop : kNewtonStopLater;
  return {strict * tolerance_, strict * contact_tolerance_, cautious ? kFirstSweepShare : 1.0, cautious ? kFirstSweepShare : kLeaveAlone, newton};
}

// Friction takes its turn before contacts are looked at.
Sweeps::Residual Sweeps::look(Contacts* contacts, const Constraints::RodsProgress& rods, bool first, int sweeps, StageClock& clock) noexcept {
  Residual residual;
  residual.rods = rods;
  const bool touches = contacts != nullptr && !contacts->empty();
  if (touches && sweeps <= kRubSweeps) residual.rubbed = rubContacts(inertia_.inverse(), *contacts, constraints_.next);
  if (touches) residual.touch = contactResidual(*contacts, constraints_.next);
  clock.lap(Stage::kContact);
  residual.strings = constraints_.lookAtStrings(constraints_.weftPulls() || !first);
  return residual;
}

bool Sweeps::reached(const Aim& aim, const Residual& r) noexcept {
  if (!r.rods.converged || r.strings > aim.share * aim.links || r.touch > aim.share * aim.contact || r.rubbed > kRubShare * aim.contact) {
    return false;
  }
  const bool rods_sure = r.rods.last_residual * inertia_.dampingSpread() <= sure_stop_ && r.rubbed == 0.0;
  return rods_sure || constraints_.rodsResidual() <= aim.links;
}

// Monotone: what is no better is undone, and the next step damped more. True: it was undone.
bool Sweeps::keepOrUndo(double& residual, const Residual& now, Contacts* contacts, SweepDamping& damping) noexcept {
  const double merit = constraints_.merit(contacts, now.rods.converged ? 0.0 : constraints_.rodsResidual());
  if (merit < best_.merit) {
    best_ = {merit, residual};
    constraints_.keepIterate(contacts);
    damping.better();
    return false;
  }
  if (!std::isfinite(best_.merit)) return false;
  constraints_.goBack(contacts);
  residual = best_.residual;
  damping.worse();
  return true;
}

bool Sweeps::isWithin(double touch) noexcept {
  const double allowed = tolerance_ / kInnerTolerance;
  return touch <= contact_tolerance_ && constraints_.rodsResidual() <= allowed && constraints_.stringsResidual() <= allowed;
}

SweepOutcome Sweeps::run(const SweepTask& task, Contacts* contacts, StageClock& clock) noexcept {
  const bool touches = contacts != nullptr && !contacts->empty();
  SweepOutcome outcome;
  SweepDamping damping(task.last_resort);
  StallWatch watch(touches);
  bool follow = task.follows;
  double before = kInfinite, touch = 0.0;
  best_ = Best();
  constraints_.beginSolve();
  while (outcome.sweeps < most_sweeps_) {
    const bool first = outcome.sweeps == 0;
    const Aim aim = aimOf(task, first, touches, outcome.sweeps);
    const Constraints::RodsProgress rods = constraints_.solveRods(
        {follow, aim.newton, first ? 0.0 : kLeaveAlone * aim.links, task.last_resort ? kInfinite : kMostViolation}, first);
    clock.lap(Stage::kWarp);
    if (!rods.converged && !task.last_resort) return {SweepEnd::kDiverged, false, outcome.sweeps};
    ++outcome.sweeps;
    const Residual now = look(contacts, rods, first, outcome.sweeps, clock);
    touch = now.touch;
    if (reached(aim, now)) {
      clock.lap(Stage::kWeft);
      return {SweepEnd::kConverged, true, outcome.sweeps};
    }
    double residual = std::max(now.strings, touch / constraints_.middleRest());
    if (!std::isfinite(residual)) {
      outcome.end = SweepEnd::kDiverged;
      break;
    }
    bool undone = false;
    if (task.last_resort) {
      undone = keepOrUndo(residual, now, contacts, damping);
      if (undone && damping.exhausted(residual)) break;
    } else if (residual > (touches ? kPoorTouchingSweep : kPoorSweep) * before) {
      damping.worse();  // too far where hardly anything holds
    } else {
      damping.better();
    }
    before = residual;
    if (undone || now.strings > aim.alone * aim.links || touch > aim.alone * aim.contact) {
      // Contact settles better along given directions.
      follow = follow || !touches;
      if (follow) constraints_.followDirections();
      else constraints_.takeDirections(task.start);
      // The picture that is solved in is of first order: off by the square of what it moves.
      const double off = !touches && !task.last_resort ? residual : follow ? kFollowReduction : kLeastReduction;
      const double enough = std::min(kMostReduction, std::max(kReductionShare * aim.links / residual, off));
      constraints_.solveNet({residual, enough, damping.at(residual)}, contacts);
    }
    clock.lap(Stage::kWeft);
    if (clock.late()) {
      outcome.end = SweepEnd::kOutOfTime;
      break;
    }
    if (!task.last_resort && watch.stalls(outcome.sweeps, std::max(rods.first_residual, residual))) break;
  }
  if (std::isfinite(best_.merit)) {
    if (outcome.end == SweepEnd::kDiverged) outcome.end = SweepEnd::kStalled;
    constraints_.goBack(contacts);
    if (touches) touch = contactResidual(*contacts, constraints_.next, false);
  }
  // Slower than it should, but what was asked for may be reached all the same.
  outcome.within = outcome.end != SweepEnd::kDiverged && isWithin(touch);
  return outcome;
}

}  // namespace curtain
