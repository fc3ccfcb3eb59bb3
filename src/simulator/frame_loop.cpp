// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/frame_loop.h"

#include <algorithm>

#include "step/schemes/composition.h"

namespace curtain {
namespace {

// Share of its path below which the cloth counts as stopped in a substep.
constexpr double kStopped = 1e-3;

FrameQuality qualityOf(const SubstepPlan& plan, const SubstepOutcome& outcome, bool stretched) noexcept {
  if (outcome.share < kStopped) return FrameQuality::kStopped;
  if (plan.isLastResort()) return FrameQuality::kBounded;
  if (outcome.late || stretched) return FrameQuality::kHurried;
  return outcome.settled ? FrameQuality::kResolved : FrameQuality::kUnsettled;
}

}  // namespace

FrameLoop::FrameLoop(Motion& motion, StepControls& controls, Budget& budget)
    : motion_(motion), controls_(controls), budget_(budget) {
  motion_.save(before_);
}

double FrameLoop::make() {
  motion_.statistics.substeps_last = 0;
  motion_.statistics.sweeps_last = 0;
  motion_.statistics.stops_last = 0;
  motion_.statistics.momentum_cut_last = 0.0;
  motion_.statistics.quality = FrameQuality::kResolved;
  motion_.forgetVelocities();
  tally_ = {};
  pins_waited_ = false;
  controls_.beginFrame();
  const double length = motion_.times.length();
  const Workers::Shift shift(motion_.workers);
  double done = 0.0;
  while (length - done > 1e-9 * length) {
    if (budget_.any() && budget_.over(Budget::Clock::now())) {
      lowerQuality(FrameQuality::kHurried);
      return done / length;
    }
    done += makeSubstep(done);
  }
  return 1.0;
}

// One substep from `done` seconds into the frame. Returns its length; 0: it was rejected.
double FrameLoop::makeSubstep(double done) {
  StepControl* steps = &controls_.main;
  SubstepPlan planned = plan(*steps, done);
  if (motion_.scene.solver.method == Method::kLeapfrog4) {
    const Budget::Clock::time_point begin = Budget::Clock::now();
    if (makeStages(planned, done)) {
      if (budget_.any()) budget_.substepTook(Budget::secondsSince(begin), true);
      countSubstep(static_cast<int>(kStages.size()));
      return planned.h;
    }
    controls_.pauseStages(motion_.times.rate());
    steps = &controls_.plain;
    planned = plan(*steps, done);
  }
  const SubstepOutcome outcome = attemptInTime(planned, done);
  if (outcome.accepted) {
    accept(*steps, planned, outcome);
    return planned.h;
  }
  reject(*steps, planned, outcome);
  return 0.0;
}

SubstepPlan FrameLoop::plan(StepControl& steps, double done) {
  if (budget_.any()) steps.allow(budget_.affordable(Budget::Clock::now()));
  return steps.next(motion_.times.length() - done, motion_.step);
}

bool FrameLoop::makeStages(const SubstepPlan& plan, double done) {
  const auto oneWay = [](const Part& part) { return !part.reversible(); };
  if (controls_.plain_frames > 0 || motion_.step.stringsPull() || motion_.parts.all.any(oneWay)) return false;
  motion_.save(before_);
  double at = done, acted = 0.0;
  for (const double gamma : kStages) {
    SubstepPlan stage = plan;
    stage.h = gamma * plan.h;
    const SubstepOutcome outcome = motion_.attempt(stage, at);
    if (!outcome.accepted || motion_.step.stringsPull() || (motion_.contact.wanted() && motion_.contact.any())) {
      motion_.restore(before_);
      motion_.contact.withdraw(acted);
      return false;
    }
    controls_.main.accepted(stage, outcome);
    controls_.plain.watch(outcome);
    motion_.contact.afterSubstep(true, outcome, motion_.state.position);
    at += stage.h;
    acted += outcome.kick;
  }
  return true;
}

// Sets the deadline and measures the time where a budget is given.
SubstepOutcome FrameLoop::attemptInTime(const SubstepPlan& plan, double done) {
  if (!budget_.any()) return motion_.attempt(plan, done);
  const Budget::Clock::time_point begin = Budget::Clock::now();
  motion_.clock.setDeadline(budget_.substepEnds());
  const SubstepOutcome outcome = motion_.attempt(plan, done);
  motion_.clock.setDeadline(Budget::Clock::time_point::max());
  budget_.substepTook(Budget::secondsSince(begin), outcome.accepted);
  return outcome;
}

// Running out of time says nothing of the step's length, unless it had a whole frame's time.
void FrameLoop::reject(StepControl& steps, const SubstepPlan& plan, const SubstepOutcome& outcome) noexcept {
  ++motion_.statistics.rejected;
  if (!outcome.late)
    steps.rejected(plan, outcome);
  else if (budget_.fresh())
    steps.tookTooLong(plan);
}

void FrameLoop::accept(StepControl& steps, const SubstepPlan& plan, const SubstepOutcome& outcome) noexcept {
  Statistics& s = motion_.statistics;
  if (outcome.late) ++s.unfinished_substeps;
  if (steps.stretched()) ++s.longer_substeps;
  if (!outcome.settled) ++s.unsettled;
  if (outcome.share < kStopped) ++s.stops, ++s.stops_last;
  if (plan.isLastResort()) ++s.last_resort_substeps;
  s.momentum_cut += outcome.momentum_cut;
  s.momentum_cut_last += outcome.momentum_cut;
  lowerQuality(qualityOf(plan, outcome, steps.stretched()));
  s.obstacles_waited += motion_.lag.substepMade(outcome.share, plan.h);
  steps.accepted(plan, outcome);
  if (&steps != &controls_.main) {
    controls_.main.watch(outcome);
    tally_.of_stages = false;
  }
  pins_waited_ = pins_waited_ || outcome.pins_wait;
  countSubstep(1);
  motion_.substepAccepted(plan.h, outcome);
}

void FrameLoop::lowerQuality(FrameQuality quality) noexcept {
  motion_.statistics.quality = std::max(motion_.statistics.quality, quality);
}

void FrameLoop::countSubstep(int steps) noexcept {
  ++motion_.statistics.substeps;
  ++motion_.statistics.substeps_last;
  tally_.steps += steps;
}

}  // namespace curtain
