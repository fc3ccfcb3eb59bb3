// SPDX-License-Identifier: BSD-3-Clause
//
// The motion made a second time in other substeps, to tell its error (ErrorEstimate), and before it begins, to guess how many
// it needs.
#include <algorithm>
#include <cmath>

#include "simulator/simulator_impl.h"
#include "solver/composition.h"

namespace curtain {

// A substep of the motion that is only compared with: what fails is divided, up to `divisions` times.
bool Simulator::Impl::makeEvenSubstep(const SubstepPlan& plan, double done, int divisions) {
  if (attempt(plan, done).accepted) {
    ++steps_made;
    return true;
  }
  if (divisions == 0) return false;
  SubstepPlan half = plan;
  half.h = 0.5 * plan.h;
  return makeEvenSubstep(half, done, divisions - 1) && makeEvenSubstep(half, done + half.h, divisions - 1);
}

// A frame in so many equal leapfrog (or composed) substeps. False: one of them failed.
bool Simulator::Impl::makeEvenFrame(int substeps) {
  constexpr int kDivisions = 5;
  SubstepPlan plan;
  plan.h = frameLength() / substeps;
  if (scene.solver.method == Method::kAuto) plan.most_phase = control.stablePhase();
  plan.precise = scene.solver.method == Method::kLeapfrog4;
  for (int k = 0; k < substeps; ++k) {
    const double done = k * plan.h;
    if (scene.solver.method == Method::kLeapfrog4 && plain_frames == 0 && makeComposed(plan, done)) continue;
    of_stages = of_stages && scene.solver.method != Method::kLeapfrog4;
    const int parts = scene.solver.method == Method::kLeapfrog4 ? static_cast<int>(kStages.size()) : 1;
    SubstepPlan part = plan;
    part.h = plan.h / parts;
    for (int p = 0; p < parts; ++p) {
      if (!makeEvenSubstep(part, done + p * part.h, kDivisions)) return false;
    }
  }
  return true;
}

// Velocities at the time of the positions. A step of another length than the last one's would else start from a velocity
// half the difference off.
void Simulator::Impl::synchronise() {
  if (state.velocity_age == 0.0) return;
  exact.currentVelocities(state, forces.last(), contact.any() ? &contact.contacts() : nullptr, velocities);
  state.velocity = velocities;
  state.velocity_age = 0.0;
  velocities_fresh = false;
}

// Substeps a frame that leapfrog is stable in, up to those the motion may use: what needs more is not moved by leapfrog, and
// stiff links under an absurd pull would ask for millions.
int Simulator::Impl::stableSubsteps() const noexcept {
  const double wanted = std::ceil(1.0 / (scene.solver.frame_rate * control.longestStableStep()));
  return static_cast<int>(std::clamp<double>(wanted, 1.0, estimate->mostSubsteps()));
}

// Before the motion begins: some frames of it, twice, to find the substeps it needs.
void Simulator::Impl::rehearse() {
  const Statistics before_all = statistics;
  const Work work = counts_work ? ledger.work() : Work();
  const StageClock stages = clock;
  const int substeps = stableSubsteps();
  const auto play = [&](int count) {
    rehearsal.state = state;
    exact.save(rehearsal.memory);
    bool made = true;
    for (int f = 0; f < estimate->rehearsalFrames() && made; ++f) {
      made = makeEvenFrame(count);
      statistics.time += frameLength();
    }
    statistics = before_all;
    return made;
  };
  const auto goBack = [&] {
    state = rehearsal.state;
    exact.restore(rehearsal.memory);
    contact.lookAfresh();
  };
  const bool coarse_made = play(substeps);
  companion.state.position = state.position;
  goBack();
  const bool fine_made = play(2 * substeps);
  if (coarse_made && fine_made) estimate->rehearsed(companion.state.position, substeps, state.position, 2 * substeps);
  goBack();
  clock = stages;
  if (counts_work) ledger.restore(work);
}

// Moves the companion by the coming frame. It goes first, so that forces and contacts stay those of the motion.
void Simulator::Impl::moveCompanion() {
  if (estimate->companionStarts()) {
    const int least = stableSubsteps();
    estimate->atLeast(least);
    companion.in_finer_steps = !estimate->halfWillDo(least);
  }
  if (estimate->companionStarts() || companion.lost) {
    synchronise();
    companion.state = state;
    exact.save(companion.memory);
  }
  const Statistics published = statistics;
  const Work work = counts_work ? ledger.work() : Work();
  const StageClock stages = clock;
  rehearsal.state = state;
  exact.save(rehearsal.memory);
  std::swap(state, companion.state);
  exact.restore(companion.memory);
  contact.lookAfresh();
  const int substeps = estimate->companionSubsteps(companion.in_finer_steps);
  if (substeps != companion.substeps) synchronise();
  companion.substeps = substeps;
  steps_made = 0;
  of_stages = true;
  companion.lost = !makeEvenFrame(substeps);
  companion.steps = steps_made;
  companion.of_stages = of_stages;
  companion.in_finer_steps = companion.in_finer_steps || companion.lost;
  exact.save(companion.memory);
  std::swap(state, companion.state);
  exact.restore(rehearsal.memory);
  contact.lookAfresh();
  statistics = published;
  clock = stages;
  if (counts_work) ledger.restore(work);
}

}  // namespace curtain
