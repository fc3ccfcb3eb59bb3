// SPDX-License-Identifier: BSD-3-Clause
//
// Frames and their substeps: the loop of Cheng 2000, Sect. 1.3.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "simulator/simulator_impl.h"
#include "solver/composition.h"

namespace curtain {

namespace {

// Overlength at a frame's end with which links count as holding in the next one.
constexpr double kHold = 0.05;
// Share of its path below which the cloth counts as stopped in a substep.
constexpr double kStopped = 1e-3;

}  // namespace

// One attempt at a substep from `done` seconds into the frame.
SubstepOutcome Simulator::Impl::attempt(const SubstepPlan& plan, double done) {
  ContactFinder* const finder = contact.wanted() ? &contact : nullptr;
  clock.start();
  if (finder == nullptr) contact.nothingTouches();
  if (finder != nullptr) setObstacles(plan, done);
  const NodeForces& now = forces.evaluate(state, statistics.time + done, plan.h);
  clock.lap(Stage::kForces);
  if (counts_work) ledger.begin(state);
  const SubstepOutcome outcome = scene.solver.method == Method::kPaper
                                     ? paper.substep(now, plan.h, finder, state, clock)
                                     : exact.substep(plan, now, finder, state, clock);
  statistics.sweeps += outcome.sweeps;
  statistics.sweeps_last += outcome.sweeps;
  if (counts_work && outcome.accepted) {
    const ExactSolver* const links = scene.solver.method == Method::kPaper ? nullptr : &exact;
    ledger.end(state, now, contact.any() ? &contact.contacts() : nullptr, links, plan.h, outcome);
  }
  return outcome;
}

// A substep of five stages. False, and nothing changed: a string pulls or something touches, which forbids to go back in
// time.
bool Simulator::Impl::makeComposed(const SubstepPlan& plan, double done) {
  if (exact.weftPulls()) return false;
  exact.save(before.memory);
  before.state = state;
  if (counts_work) before.work = ledger.work();
  double at = done;
  for (const double gamma : kStages) {
    SubstepPlan stage = plan;
    stage.h = gamma * plan.h;
    const SubstepOutcome outcome = attempt(stage, at);
    if (!outcome.accepted || exact.weftPulls() || (contact.wanted() && contact.any())) {
      state = before.state;
      exact.restore(before.memory);
      if (counts_work) ledger.restore(before.work);
      contact.lookAfresh();
      contact.takeBack(at - done);
      return false;
    }
    control.accepted(stage, outcome);
    plain_control.watch(outcome);
    contact.afterSubstep(true, stage.h, outcome.scale, state.position);
    at += stage.h;
  }
  steps_made += static_cast<int>(kStages.size());
  return true;
}

SubstepPlan Simulator::Impl::planSubstep(StepControl& steps, double remaining) {
  if (budget.any()) steps.allow(budget.affordable(Budget::Clock::now()));
  return steps.next(remaining, exact);
}

// The same where the frame's computing time is limited.
SubstepOutcome Simulator::Impl::attemptInTime(const SubstepPlan& plan, double done) {
  if (!budget.any()) return attempt(plan, done);
  const Budget::Clock::time_point begin = Budget::Clock::now();
  clock.setDeadline(budget.substepEnds());
  const SubstepOutcome outcome = attempt(plan, done);
  clock.setDeadline(Budget::Clock::time_point::max());
  budget.substepTook(std::chrono::duration<double>(Budget::Clock::now() - begin).count(), outcome.accepted);
  return outcome;
}

// Moves the obstacles. In the last resort those near the cloth go no further than a node may, and what is inside comes out by no more,
// so that all that is asked of the solve vanishes with the reach.
void Simulator::Impl::setObstacles(const SubstepPlan& plan, double done) noexcept {
  const double frame_length = frameLength(), from = (done - obstacle_lag) / frame_length;
  obstacle_share = 1.0;
  obstacles.setSubstep(from, from + plan.h / frame_length);
  const double most = plan.last_resort ? plan.reach * shortest_link : std::numeric_limits<double>::infinity();
  contact.boundRecovery(most);
  if (!plan.last_resort) return;
  double path = 0.0;
  for (int o = 0; o < obstacles.count(); ++o) {
    if (contact.standing(o, state.position) == ObstacleStanding::kNear) path = std::max(path, obstacles.path(o));
  }
  path *= plan.h / frame_length;
  if (path <= most) return;
  obstacle_share = most / path;
  obstacles.setSubstep(from, from + obstacle_share * plan.h / frame_length);
}

// What bounds took. Obstacles wait for the cloth: further on they might go through it.
void Simulator::Impl::countStops(bool last_resort, const SubstepOutcome& outcome, double h) noexcept {
  if (outcome.share < kStopped) ++statistics.stops;
  if (last_resort) ++statistics.last_resort_substeps;
  statistics.momentum_cut += outcome.momentum_cut;
  pins_wait = pins_wait || outcome.pins_wait;
  const double waits = (1.0 - outcome.share * obstacle_share) * h;
  if (obstacles.anyMoved()) statistics.obstacles_waited += waits;
  obstacle_lag += waits;
}

// One substep from `done` seconds into the frame. Returns how far it came: 0 when it was rejected.
double Simulator::Impl::makeSubstep(double done) {
  const double frame_length = frameLength();
  StepControl* steps = &control;
  SubstepPlan plan = planSubstep(control, frame_length - done);
  if (scene.solver.method == Method::kLeapfrog4) {
    const Budget::Clock::time_point begin = budget.any() ? Budget::Clock::now() : Budget::Clock::time_point();
    if (plain_frames == 0 && makeComposed(plan, done)) {
      if (budget.any()) budget.substepTook(std::chrono::duration<double>(Budget::Clock::now() - begin).count(), true);
      ++statistics.substeps;
      ++statistics.substeps_last;
      return plan.h;
    }
    // As auto would, for a second: strings that pull now and then would else change the scheme all the time, and every change
    // shakes them.
    if (plain_frames == 0) plain_frames = static_cast<int>(std::ceil(scene.solver.frame_rate));
    steps = &plain_control;
    plan = planSubstep(plain_control, frame_length - done);
  }
  const SubstepOutcome outcome = attemptInTime(plan, done);
  if (outcome.disturbed) {
    if (rest.wakeFor(exact.held().disturbed(), made_time)) takeOverSleepers();
    return 0.0;
  }
  if (!outcome.accepted) {
    ++statistics.rejected;
    // That there was no time left for it says nothing of its length, unless it had a whole frame's.
    if (!outcome.late) steps->rejected(plan);
    else if (budget.fresh()) steps->tookTooLong(plan);
    return 0.0;
  }
  if (outcome.late) ++statistics.unfinished_substeps;
  if (steps->stretched()) ++statistics.longer_substeps;
  steps->accepted(plan, outcome);
  ++steps_made;
  of_stages = of_stages && steps == &control;
  if (steps != &control) control.watch(outcome);
  ++statistics.substeps;
  ++statistics.substeps_last;
  countStops(plan.last_resort, outcome, plan.h);
  if (!outcome.settled) ++statistics.unsettled;
  contact.afterSubstep(outcome.settled, plan.h, outcome.scale, state.position);
  return plan.h;
}

// Pinned nodes answer no force; those that are moved go with their velocity.
void Simulator::Impl::startPins() {
  for (PinMove& move : pin_moves) {
    const Vec3 velocity = (move.target - state.position.at(move.node)) * scene.solver.frame_rate;
    const double share = move.behind ? std::min(1.0, followingSpeed(scene) / velocity.norm()) : 1.0;
    state.velocity.set(move.node, share * velocity);
    move.behind = share < 1.0;
  }
}

// Those that have not got there, because the frame ended early, go on in the next one.
void Simulator::Impl::stopPins(bool whole) {
  std::size_t left = 0;
  for (PinMove& move : pin_moves) {
    state.velocity.set(move.node, Vec3::Zero());
    if (whole && !move.behind) {
      state.position.set(move.node, move.target);
    } else {
      move.behind = true;
      pin_moves[left++] = move;
    }
  }
  pin_moves.resize(left);
}

// Returns how much of the frame was made, as a share of it: less than 1 when there was no time for more.
double Simulator::Impl::makeFrame() {
  const double frame_length = frameLength();
  double done = 0.0;
  while (frame_length - done > 1e-9 * frame_length) {
    if (budget.any() && budget.over(Budget::Clock::now())) return done / frame_length;
    done += makeSubstep(done);
  }
  return 1.0;
}

// Before a frame, where the error is asked for: the companion moves ahead.
void Simulator::Impl::estimateError() {
  clock.start();
  const bool affords = budget.affordsCompanion();
  if (estimate->companionMoves() && affords) {
    const Budget::Clock::time_point begin = Budget::Clock::now();
    moveCompanion();
    budget.companionTook(std::chrono::duration<double>(Budget::Clock::now() - begin).count());
  } else if (estimate->companionMoves()) {
    companion.lost = true;
    ++statistics.estimates_skipped;
  }
  if (control.askFor(estimate->substeps())) synchronise();
  clock.lap(Stage::kEstimate);
}

// What a frame needs to know before its first substep.
void Simulator::Impl::prepareFrame(Budget::Clock::time_point begin) {
  const bool links_hold = pin_moves.empty() && std::max(statistics.warp_stretch, statistics.weft_stretch) < kHold;
  contact.beginFrame(links_hold);
  forces.setLinksHold(links_hold);
  if (estimate != nullptr && frame == 0) {
    clock.start();
    rehearse();  // before the budget counts: the first frame takes what it takes
    clock.lap(Stage::kEstimate);
  }
  budget.beginFrame(frame == 0 && budget.any() ? Budget::Clock::now() : begin);
  if (estimate != nullptr) estimateError();
  statistics.substeps_last = 0;
  statistics.sweeps_last = 0;
  velocities_fresh = false;
  steps_made = 0;
  of_stages = true;
  if (plain_frames > 0) --plain_frames;
}

// share: of the frame that was made.
void Simulator::Impl::finishFrame(double share) {
  const double frame_length = frameLength();
  made_time += share * frame_length;
  if (share < 1.0) {
    ++statistics.shortened_frames;
    statistics.lost_time += (1.0 - share) * frame_length;
    companion.lost = true;
  }
  if (estimate != nullptr) {
    const bool compares = estimate->companionMoves() && !companion.lost;
    estimate->frameMade(state.position, steps_made, compares ? &companion.state.position : nullptr, companion.steps,
                        of_stages && companion.of_stages);
    statistics.position_error = estimate->perSecond();
    clock.lap(Stage::kEstimate);
  }
  obstacles.endFrame(share - obstacle_lag / frame_length);
  obstacle_lag = 0.0;
  ++frame;
  ++revision;
  statistics.frames = frame;
  statistics.time = timeOf(frame);
}

void Simulator::Impl::step() {
  const Budget::Clock::time_point begin = Budget::Clock::now();
  statistics.time = timeOf(frame);
  obstacles.beginFrame(timeOf(frame + 1));
  wakeForFrame();
  if (rest.asleep().full()) {
    sleepThrough();
    countTime(begin);
    return;
  }
  if (!most_energy) keepEnergy();
  prepareFrame(begin);
  startPins();
  const double share = makeFrame();
  const Budget::Clock::time_point tail_begin = budget.any() ? Budget::Clock::now() : begin;
  keepEnergy();
  stopPins(share == 1.0 && !pins_wait);
  pins_wait = false;
  finishFrame(share);
  measure();
  fallAsleep();
  statistics.stage_seconds = clock.seconds();
  countTime(begin);
  if (!budget.any()) return;
  budget.endFrame(share, tail_begin, Budget::Clock::now());
  if (statistics.step_seconds > budget.seconds()) ++statistics.late_frames;
}

void Simulator::Impl::countTime(Budget::Clock::time_point begin) {
  const double seconds = std::chrono::duration<double>(Budget::Clock::now() - begin).count();
  statistics.step_seconds = seconds;
  statistics.step_seconds_max = std::max(statistics.step_seconds_max, seconds);
  statistics.step_seconds_sum += seconds;
}

void Simulator::Impl::measure() {
  clock.start();
  Statistics& s = statistics;
  const Stretch warp = warpStretch(pattern, state.position);
  s.warp_stretch = warp.longer;
  s.warp_compression = warp.shorter;
  s.weft_stretch = weftStretch(pattern, state.position);
  s.warp_stretch_max = std::max(s.warp_stretch_max, s.warp_stretch);
  s.weft_stretch_max = std::max(s.weft_stretch_max, s.weft_stretch);
  s.warp_compression_max = std::max(s.warp_compression_max, s.warp_compression);
  const bool near = contact.wanted() && contact.any();
  s.contacts = near ? contact.contactCount() : 0;
  s.contacts_max = std::max(s.contacts_max, s.contacts);
  if (near) s.penetration_max = std::max(s.penetration_max, contact.deepestPenetration(state.position));
  const double sum = s.warp_stretch + s.warp_compression + s.weft_stretch;
  s.finite = std::isfinite(sum);
  clock.lap(Stage::kFinish);
}

const Field3& Simulator::Impl::currentVelocities() {
  if (velocities_fresh) return velocities;
  if (frame == 0 || state.velocity_age == 0.0) {
    velocities = state.velocity;
  } else {
    exact.currentVelocities(state, forces.last(), contact.any() ? &contact.contacts() : nullptr, velocities);
  }
  velocities_fresh = true;
  return velocities;
}

}  // namespace curtain
