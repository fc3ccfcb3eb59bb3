// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/accuracy/error_control.h"

#include <algorithm>
#include <cmath>

#include "step/constants.h"

namespace curtain {

ErrorControl::ErrorControl(Motion& motion, StepControls& controls, FrameLoop& loop, Budget& budget)
    : motion_(motion),
      controls_(controls),
      loop_(loop),
      budget_(budget),
      estimate_(motion.scene.solver, motion.pattern) {
  motion_.save(start_);
  reference_.at = start_;
}

// Makes a substep; a failed one is divided, up to `divisions` times.
bool ErrorControl::makeSubstep(const SubstepPlan& plan, double done, int divisions) {
  if (motion_.attempt(plan, done).accepted) {
    ++tally_.steps;
    return true;
  }
  if (divisions == 0) return false;
  SubstepPlan half = plan;
  half.h = 0.5 * plan.h;
  return makeSubstep(half, done, divisions - 1) && makeSubstep(half, done + half.h, divisions - 1);
}

// A frame in so many equal leapfrog (or composed) substeps. False: one of them failed.
bool ErrorControl::makeFrame(int substeps) {
  constexpr int kDivisions = 5;
  const SolverParams& params = motion_.scene.solver;
  const bool composed = params.method == Method::kLeapfrog4;
  SubstepPlan plan;
  plan.h = motion_.times.length() / substeps;
  if (params.method == Method::kAuto) plan.max_phase = StepControl::phaseShare(motion_.pattern) * kStablePhase;
  plan.precise = composed;
  const int parts = ErrorEstimate::stepsPerSubstep(params.method);
  SubstepPlan part = plan;
  part.h = plan.h / parts;
  for (int k = 0; k < substeps; ++k) {
    const double done = k * plan.h;
    if (composed && loop_.makeStages(plan, done)) {
      tally_.steps += parts;
      continue;
    }
    tally_.of_stages = tally_.of_stages && !composed;
    for (int p = 0; p < parts; ++p) {
      if (!makeSubstep(part, done + p * part.h, kDivisions)) return false;
    }
  }
  return true;
}

// Frames of a trial run, which statistics do not count. False: a substep failed.
bool ErrorControl::makeFrames(int count, int substeps) {
  const Statistics published = motion_.statistics;
  const StageClock stages = motion_.clock;
  tally_ = {};
  bool made = true;
  for (int f = 0; f < count && made; ++f) {
    made = makeFrame(substeps);
    motion_.statistics.time += motion_.times.length();
  }
  motion_.statistics = published;
  motion_.clock = stages;
  return made;
}

// Substeps a frame that leapfrog is stable in, at most those that the motion may use: stiff links under an extreme pull
// would ask for millions.
int ErrorControl::stableSubsteps() const noexcept {
  const double wanted = std::ceil(1.0 / (motion_.times.rate() * controls_.main.longestStableStep()));
  return static_cast<int>(std::clamp<double>(wanted, 1.0, estimate_.maxSubsteps()));
}

void ErrorControl::makePilotRuns() {
  motion_.clock.start();
  motion_.save(start_);
  const int substeps = stableSubsteps();
  const bool coarse_made = makeFrames(estimate_.pilotFrames(), substeps);
  reference_.at.state.position = motion_.state.position;
  motion_.restore(start_);
  const bool fine_made = makeFrames(estimate_.pilotFrames(), 2 * substeps);
  if (coarse_made && fine_made) {
    estimate_.pilotsMade(reference_.at.state.position, substeps, motion_.state.position, 2 * substeps);
  }
  motion_.restore(start_);
  motion_.clock.lap(Stage::kEstimate);
}

// The reference run has the motion's pins.
void ErrorControl::movePinsAsIn(const ClothState& state) noexcept {
  const ClothPattern& pattern = motion_.pattern;
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
    if (pattern.pinned[n] != kPinned) continue;
    motion_.state.position.set(n, state.position.at(n));
    motion_.state.velocity.set(n, state.velocity.at(n));
  }
}

// Advances the reference run by the coming frame, before the motion, so that forces and contacts end as the motion's.
void ErrorControl::moveReference() {
  if (estimate_.referenceStarts()) {
    const int least = stableSubsteps();
    estimate_.atLeast(least);
    reference_.in_finer_steps = !estimate_.halfWillDo(least);
  }
  if (estimate_.referenceStarts() || reference_.lost) {
    motion_.synchronise();
    motion_.save(reference_.at);
  }
  motion_.save(start_);
  motion_.restore(reference_.at);
  movePinsAsIn(start_.state);
  const int substeps = estimate_.referenceSubsteps(reference_.in_finer_steps);
  if (substeps != reference_.substeps) motion_.synchronise();
  reference_.substeps = substeps;
  reference_.lost = !makeFrames(1, substeps);
  reference_.tally = tally_;
  reference_.in_finer_steps = reference_.in_finer_steps || reference_.lost;
  motion_.save(reference_.at);
  motion_.restore(start_);
}

void ErrorControl::beginFrame() {
  motion_.clock.start();
  if (estimate_.referenceMoves() && budget_.affordsCompanion()) {
    const Budget::Clock::time_point begin = Budget::Clock::now();
    moveReference();
    budget_.referenceTook(Budget::secondsSince(begin));
  } else if (estimate_.referenceMoves()) {
    lose();
    ++motion_.statistics.estimates_skipped;
  }
  if (controls_.main.askFor(estimate_.substeps())) motion_.synchronise();
  motion_.clock.lap(Stage::kEstimate);
}

void ErrorControl::endFrame(double share) {
  if (share < 1.0) lose();
  const bool compares = estimate_.referenceMoves() && !reference_.lost;
  const StepTally& made = loop_.tally();
  estimate_.frameMade(motion_.state.position, made.steps, compares ? &reference_.at.state.position : nullptr,
                      reference_.tally.steps, made.of_stages && reference_.tally.of_stages);
  motion_.statistics.position_error = estimate_.perSecond();
  motion_.clock.lap(Stage::kEstimate);
}

}  // namespace curtain
