// SPDX-License-Identifier: BSD-3-Clause
#include "step/sweeps.h"

#include <algorithm>
#include <cmath>

#include "scene/infinity.h"
#include "step/constants.h"

namespace curtain {
bool StallWatch::stalls(int sweeps, double residual) noexcept {
  if (sweeps % kStallWindow != 0) return false;
  const bool improves = residual < kStallFactor * before_;
  before_ = residual;
  return !improves;
}

Sweeps::Sweeps(Constraints& constraints, const NodeInertia& inertia, double tolerance, double contact_tolerance,
               int max_sweeps)
    : constraints_(constraints),
      inertia_(inertia),
      tolerance_(kInnerTolerance * tolerance),
      contact_tolerance_(kInnerTolerance * contact_tolerance),
      max_sweeps_(max_sweeps) {}

// What the motion lets contacts be off by, but at least this share of their tolerance [m].
double Sweeps::touchAim(const SweepTask& task, double least) const noexcept {
  const double most = task.last_resort ? 1.0 : kMaxTouch;
  return std::clamp(kShareOfPath * task.path, least * contact_tolerance_, most * contact_tolerance_);
}

Sweeps::Aim Sweeps::aimOf(const SweepTask& task, bool touches, int sweeps) const noexcept {
  const bool first = sweeps == 0, early = sweeps < (touches ? kStrictSweeps : kStrictSweepsOfLinks);
  double strict = 1.0, contact = contact_tolerance_;
  if (touches) {
    contact = touchAim(task, early ? kStrictShare : 1.0);
    strict = std::min(contact / contact_tolerance_, 1.0);
  } else if (early && (constraints_.stringsPull() || constraints_.stringsAct())) {
    // The last resort leaves no more than its far shorter successors can correct without a jump.
    strict =
        task.last_resort ? kLastResortShare
        : task.weight_path > 0.0
            ? std::clamp(kShareOfWeight * task.weight_path / (constraints_.middleRest() * tolerance_), kMinShare, 1.0)
            : 1.0;
  }
  const bool cautious = first && !task.last_resort;
  return {strict * tolerance_, contact, cautious ? kFirstSweepShare : 1.0, cautious ? kFirstSweepShare : kLeaveAlone};
}

// Slides are turned, if they are, before contacts are measured.
Sweeps::Residual Sweeps::measureResidual(const Constraints::RodsProgress& rods, bool first, bool turns,
                                         StageClock& clock) noexcept {
  Residual residual;
  residual.rods = rods;
  ContactRows& contacts = constraints_.contacts();
  if (!contacts.all().empty() && turns) {
    contacts.slide(inertia_.inverse(), constraints_.next);
    constraints_.settleGuide();
  }
  contacts.relinearise(constraints_.next);
  residual.touch = contacts.residual(constraints_.next, true, max_touch_);
  clock.lap(Stage::kContact);
  residual.strings = constraints_.checkStrings(constraints_.stringsPull() || !first);
  return residual;
}

bool Sweeps::reached(const Aim& aim, const Residual& r) noexcept {
  return r.rods.converged && r.strings <= aim.share * aim.links && r.touch <= aim.share * aim.contact &&
         constraints_.rodsResidual() <= aim.links;
}

// Accepts the sweep if it reduces the merit; else undoes it and increases the damping. True: it was undone.
bool Sweeps::keepOrUndo(double& residual, const Residual& now, SweepDamping& damping) noexcept {
  const double merit = constraints_.merit(now.rods.converged ? 0.0 : constraints_.rodsResidual());
  if (merit < best_.merit) {
    best_ = {merit, residual};
    constraints_.saveIterate();
    damping.better();
    return false;
  }
  if (!std::isfinite(best_.merit)) return false;
  constraints_.restoreIterate();
  residual = best_.residual;
  damping.worse();
  return true;
}

bool Sweeps::linksHold() noexcept {
  const double allowed = tolerance_ / kInnerTolerance;
  return constraints_.rodsResidual() <= allowed && constraints_.checkStrings(true) <= (1.0 - kMaxGive) * allowed;
}

bool Sweeps::isWithin(bool recovers) noexcept {
  return constraints_.contacts().residual(constraints_.next, recovers, max_touch_) <= max_touch_ && linksHold();
}

SweepOutcome Sweeps::run(const SweepTask& task, StageClock& clock) noexcept {
  const bool touches = !constraints_.contacts().all().empty();
  SweepOutcome outcome;
  SweepDamping damping(task.last_resort ? kMaxDamping : kLargestDamping);
  StallWatch watch;
  bool follow = task.follows;
  double before = kInfinity;
  best_ = Best();
  max_touch_ = touchAim(task, 1.0);
  constraints_.beginSolve();
  while (outcome.sweeps < max_sweeps_) {
    const bool first = outcome.sweeps == 0;
    const Aim aim = aimOf(task, touches, outcome.sweeps);
    const Constraints::RodsProgress rods =
        constraints_.solveRods({follow,
                                task.precise                           ? kPreciseStop
                                : first && !constraints_.stringsPull() ? kNewtonStop
                                                                       : kNewtonStopLater,
                                first ? 0.0 : kLeaveAlone * aim.links, task.last_resort ? kInfinity : kMaxViolation});
    clock.lap(Stage::kWarp);
    if (first) outcome.predicted_violation = rods.first_residual;
    if (!rods.converged && !task.last_resort) return {SweepEnd::kDiverged, false, outcome.sweeps};
    ++outcome.sweeps;
    const bool turns = outcome.sweeps <= kFrictionSweeps || (task.follows && !task.last_resort);
    const Residual now = measureResidual(rods, first, turns, clock);
    if (reached(aim, now)) {
      clock.lap(Stage::kWeft);
      return {SweepEnd::kConverged, true, outcome.sweeps, outcome.predicted_violation};
    }
    double residual = std::max(now.strings, now.touch / constraints_.middleRest());
    if (!std::isfinite(residual)) {
      outcome.end = SweepEnd::kDiverged;
      break;
    }
    const bool worse = residual > before;
    bool undone = false;
    if (task.last_resort) {
      undone = keepOrUndo(residual, now, damping);
      if (undone && damping.exhausted(residual)) break;
    } else if (worse) {
      damping.worse();  // too far along directions that hardly anything constrains
    } else {
      damping.better();
    }
    before = residual;
    if (undone || now.strings > aim.alone * aim.links || now.touch > aim.alone * aim.contact) {
      // With contact, directions are those of the substep's start, along which the scheme's forces act, until a sweep
      // makes it worse: under a heavy load the rods leave so little of a node's mobility that directions which have
      // turned a little make pushes grow from sweep to sweep.
      follow = follow || !touches || worse;
      if (follow)
        constraints_.followDirections();
      else
        constraints_.setDirections(task.start);
      const bool newton = !touches && !task.last_resort;
      const double worth = newton ? residual : touches ? kContactReduction : kReduction;
      const double enough = std::min(kReduction, std::max(kReduction * aim.links / residual, worth));
      constraints_.solveNet({residual, enough, damping.at(residual), newton});
    }
    clock.lap(Stage::kWeft);
    if (clock.late()) {
      outcome.end = SweepEnd::kOutOfTime;
      break;
    }
    if (!task.last_resort && watch.stalls(outcome.sweeps, std::max(rods.first_residual, residual))) break;
  }
  return conclude(outcome);
}

// The solve did not converge; it may still be within the user's tolerance.
SweepOutcome Sweeps::conclude(SweepOutcome outcome) noexcept {
  const bool returns = std::isfinite(best_.merit);
  if (returns) {
    if (outcome.end == SweepEnd::kDiverged) outcome.end = SweepEnd::kStalled;
    constraints_.restoreIterate();
  }
  outcome.within = outcome.end != SweepEnd::kDiverged && isWithin(!returns);
  return outcome;
}

}  // namespace curtain
