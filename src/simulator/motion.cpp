// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/motion.h"

#include <algorithm>
#include <cmath>

namespace curtain {

Motion::Motion(const Scene& scene_, const ClothPattern& pattern_, const FrameTimes& times_,
               const ShapeMaker& make_shape)
    : scene(scene_),
      pattern(pattern_),
      times(times_),
      initial(makeInitialState(scene, pattern)),
      state(initial),
      obstacles(scene, make_shape),
      workers(threadsFor(scene.solver.threads, pattern.grid.nodeCount())),
      parts{scene, pattern, obstacles, workers},
      forces(scene, pattern, parts.all),
      contact(pattern, scene.contact, obstacles, scene.solver.stretch_tolerance, workers),
      lag(pattern, times, obstacles, contact),
      step(pattern, parts.forSolver(), scene.solver.stretch_tolerance, scene.solver.max_sweeps, workers),
      paper(pattern) {
  for (Part* const part : parts.all) part->reset(state);
  measureParts();
  step.expectContacts(contact.capacity());
  velocities_.assign(pattern.grid.size(), 0.0);
  pulls_.assign(pattern.grid.size(), 0.0);
}

void Motion::reset() {
  state = initial;
  forces.reset();
  obstacles.reset();
  contact.forget();
  step.reset();
  for (Part* const part : parts.all) part->reset(state);
  clock.reset();
  statistics = Statistics();
  step.account().restore({});
  measureParts();
  velocities_fresh_ = false;
}

SubstepOutcome Motion::attempt(const SubstepPlan& plan, double done) {
  const bool by_paper = scene.solver.method == Method::kPaper;
  ContactFinder* const finder = contact.wanted() ? &contact : nullptr;
  clock.start();
  if (finder == nullptr)
    contact.skipSubstep();
  else
    lag.setSubstep(plan, done, state.position);
  SubstepAhead ahead;
  if (forces.begin(state, statistics.time + done, done, plan.h)) {
    step.copyPulls(state, pushing(), pulls_);
    ahead = {step.kickOf(plan, state), step.isBackward(plan), &pulls_};
  }
  const NodeForces& now = forces.evaluate(state, ahead);
  clock.lap(Stage::kForces);
  if (counts_work) step.account().open(state);
  const SubstepOutcome outcome =
      by_paper ? paper.substep(now, plan.h, finder, state, clock) : step.substep(plan, now, finder, state, clock);
  statistics.sweeps += outcome.sweeps;
  statistics.sweeps_last += outcome.sweeps;
  if (counts_work && outcome.accepted) book(now, plan.h, outcome);
  return outcome;
}

void Motion::book(const NodeForces& acting, double h, const SubstepOutcome& outcome) noexcept {
  EnergyAccount& account = step.account();
  const bool by_paper = scene.solver.method == Method::kPaper;
  if (by_paper)
    account.bookForces(state.velocity, acting, nullptr, outcome.kick);
  else
    step.book(state, acting, outcome);
  account.bookContacts(contact.contacts(), state.velocity,
                       outcome.scale != 0.0 ? outcome.kick / outcome.scale : 1.0 / h);
}

void Motion::substepAccepted(double h, const SubstepOutcome& outcome) noexcept {
  contact.afterSubstep(outcome.settled, outcome, state.position);
  const Step* const links = scene.solver.method == Method::kPaper ? nullptr : &step;
  const SubstepMade made{h, state, forces.last(), links, pushing(), outcome.scale};
  for (Part* const part : parts.all) part->substepDone(made);
}

bool Motion::driven() const {
  return parts.all.any([this](const Part& part) { return part.drives(state); });
}

void Motion::pinsChanged() {
  contact.pinsChanged();
  step.pinsChanged();
  if (scene.solver.method == Method::kPaper) paper.pinsChanged();
}

void Motion::afterPinsChanged() noexcept {
  contact.invalidateStart();
  step.afterPinsChanged();
  velocities_fresh_ = false;
}

void Motion::save(Checkpoint& checkpoint) const {
  checkpoint.state = state;
  step.save(checkpoint.memory);
  checkpoint.work = step.account().work();
}

void Motion::restore(const Checkpoint& checkpoint) {
  state = checkpoint.state;
  step.restore(checkpoint.memory);
  step.account().restore(checkpoint.work);
  contact.invalidateStart();
  velocities_fresh_ = false;
}

void Motion::computeVelocities() noexcept { step.currentVelocities(state, forces.last(), pushing(), velocities_); }

const Field3& Motion::velocities() {
  if (velocities_fresh_) return velocities_;
  if (times.frame() == 0 || state.velocity_age == 0.0)
    velocities_ = state.velocity;
  else
    computeVelocities();
  velocities_fresh_ = true;
  return velocities_;
}

void Motion::synchronise() {
  if (state.velocity_age == 0.0) return;
  computeVelocities();
  state.velocity = velocities_;
  state.velocity_age = 0.0;
  velocities_fresh_ = false;
}

Energy Motion::energy() {
  const Field3& velocity = velocities();
  Energy energy;
  for (std::size_t n = 0; n < pattern.grid.size(); ++n) {
    if (pattern.pinned[n] != kPinned) energy.kinetic += 0.5 * pattern.mass[n] * velocity.at(n).squaredNorm();
    energy.potential -= pattern.mass[n] * scene.gravity.dot(state.position.at(n));
  }
  double elastic = 0.0;
  step.elasticAt(state.position, elastic);
  energy.potential += elastic + step.distances().energy(state.position);
  return energy;
}

void Motion::measureParts() noexcept {
  for (const Part* const part : parts.all) part->measure(state, statistics);
}

void Motion::measureState() noexcept {
  measureParts();
  const Stretch warp = warpStretch(pattern, state.position);
  statistics.warp_stretch = warp.longer;
  statistics.warp_compression = warp.shorter;
  statistics.weft_stretch = std::max(weftStretch(pattern, state.position), step.distances().stretch(state.position));
}

void Motion::measure() noexcept {
  clock.start();
  measureState();
  Statistics& s = statistics;
  s.warp_stretch_max = std::max(s.warp_stretch_max, s.warp_stretch);
  s.weft_stretch_max = std::max(s.weft_stretch_max, s.weft_stretch);
  s.warp_compression_max = std::max(s.warp_compression_max, s.warp_compression);
  const bool near = contact.wanted() && contact.any();
  s.contacts = near ? static_cast<int>(contact.pushing().size()) : 0;
  s.contacts_max = std::max(s.contacts_max, s.contacts);
  if (near) s.penetration_max = std::max(s.penetration_max, contact.deepestPenetration(state.position));
  s.finite = std::isfinite(s.warp_stretch + s.warp_compression + s.weft_stretch);
  clock.lap(Stage::kFinish);
}

}  // namespace curtain
