// SPDX-License-Identifier: BSD-3-Clause
#include "step/step.h"

#include <algorithm>
#include <cmath>

#include "cloth/free_body.h"
#include "step/constants.h"

namespace curtain {
namespace {

bool isWithinNumbers(const Field3& position) noexcept {
  const auto within = [](const Field& values) {
    // Written so that NaN fails.
    return std::all_of(values.begin(), values.end(), [](double value) { return std::abs(value) <= kBeyond; });
  };
  return within(position.x) && within(position.y) && within(position.z);
}

// No node is pinned.
bool isFree(const ClothPattern& pattern) noexcept {
  return std::none_of(pattern.pinned.begin(), pattern.pinned.end(), [](std::uint8_t pin) { return pin != 0; });
}

}  // namespace

Step::Step(const ClothPattern& pattern, const SolverParts& parts, double stretch_tolerance, int max_sweeps,
           const Workers& workers)
    : pattern_(pattern),
      free_(isFree(pattern)),
      stretch_tolerance_(stretch_tolerance),
      smallest_rest_(shortestLink(pattern)),
      inertia_(pattern),
      elastic_(parts.elastic),
      constraints_(pattern, parts, kMaxGive * stretch_tolerance, inertia_, workers),
      sweeps_(constraints_, inertia_, stretch_tolerance, stretch_tolerance * smallest_rest_, max_sweeps),
      account_(pattern, inertia_, stretch_tolerance, constraints_.middleRest()),
      last_resort_(pattern, constraints_.distances()) {
  if (elastic_ != nullptr) inertia_.setElastic(elastic_->omegaSquared());
}

void Step::setStretchTolerance(double tolerance) noexcept {
  stretch_tolerance_ = tolerance;
  constraints_.setTolerance(kMaxGive * tolerance);
  sweeps_.setTolerances(tolerance, tolerance * smallest_rest_);
  account_.setStretchTolerance(tolerance);
}

void Step::reset() noexcept {
  account_.setHeld(0.0);
  left_off_ = false;
  constraints_.reset();
  inertia_.forget();
}

void Step::pinsChanged() noexcept {
  free_ = isFree(pattern_);
  inertia_.pinsChanged();
  if (elastic_ != nullptr) {
    elastic_->pinsChanged();
    inertia_.setElastic(elastic_->omegaSquared());
  }
  constraints_.pinsChanged();
  account_.pinsChanged();
}

void Step::afterPinsChanged() noexcept {
  constraints_.slackenBetweenPins();
  inertia_.tensions().heaviest = inertia_.heaviest();
  account_.setHeld(0.0);
}

Scheme& Step::schemeOf(SchemeKind kind) noexcept {
  switch (kind) {
    case SchemeKind::kLeapfrog:
      break;
    case SchemeKind::kImplicit:
      return implicit_;
    case SchemeKind::kLastResort:
      return last_resort_;
  }
  return leapfrog_;
}

SubstepOutcome Step::substep(const SubstepPlan& plan, const NodeForces& forces, ContactFinder* finder,
                             ClothState& state, StageClock& clock) noexcept {
  SubstepOutcome outcome;
  const Attempt attempt = predict(plan, forces, finder, state, clock, outcome);
  Progress progress = solveAndVerify(attempt);
  judge(attempt, progress, outcome);
  if (plan.isLastResort() && !progress.settled) boundPath(attempt, progress, outcome);
  outcome.accepted = progress.settled || plan.isLastResort();
  if (outcome.accepted) accept(attempt, progress, outcome);
  constraints_.end(outcome.accepted);
  inertia_.setGuided(true);  // guided nodes stand in the last resort alone, not in what is made of pins after it
  if (!outcome.accepted) constraints_.distances().resume(state);
  clock.lap(Stage::kFinish);
  return outcome;
}

// Eqs. (1) and (2). Schemes with velocities at the end of the step use forces that act until then; leapfrog's act for
// half a step less.
Step::Attempt Step::predict(const SubstepPlan& plan, const NodeForces& forces, ContactFinder* finder, ClothState& state,
                            StageClock& clock, SubstepOutcome& outcome) noexcept {
  Scheme& scheme = schemeOf(plan.scheme);
  const Scheme::Rules& rules = scheme.rules();
  const double kick = state.velocity_age + (1.0 - rules.age) * plan.h;
  const double scale = plan.h * kick;
  inertia_.setGuided(!plan.isLastResort());
  inertia_.set(forces, kick, scale, plan.max_phase, rules.backward);
  if (elastic_ != nullptr) elastic_->begin(inertia_, inertia_.inverse(), scale, !rules.follows);
  // Warm start only along fixed directions: with present directions old tensions diverge where rods have turned much.
  const double before = inertia_.tensions().scale;
  const double ratio = !rules.follows && before != 0.0 ? scale / before : 0.0;
  const Scheme::Task task{plan, kick, forces, inertia_, elastic_};
  const Attempt attempt{plan, forces, finder, state, clock, scheme, kick, ratio, scheme.start(task, state, outcome)};
  constraints_.begin(attempt.start, state, ratio, !plan.isLastResort(), forces.gravity.norm());
  clock.lap(Stage::kPredict);
  return attempt;
}

// Eqs. (3) and (4). Solves, and solves again with the contacts that verification adds, until nothing is crossed or that
// does not help.
Step::Progress Step::solveAndVerify(const Attempt& attempt) noexcept {
  const SubstepPlan& plan = attempt.plan;
  const bool last_resort = plan.isLastResort();
  const Field3 &from = attempt.state.position, &next = constraints_.next;
  SweepTask task{attempt.start.state.position,
                 attempt.scheme.rules().follows,
                 last_resort,
                 plan.precise,
                 attempt.forces.gravity.norm() * plan.h * plan.h,
                 0.0};
  ContactFinder* const finder = attempt.finder;
  const auto act =
      attempt.scheme.rules().follows ? ContactFinder::ForcesAct::kAtEnd : ContactFinder::ForcesAct::kAtStart;
  Contacts* const contacts = finder != nullptr ? &finder->begin(from, next, plan.h, act) : nullptr;
  if (finder != nullptr) attempt.clock.lap(Stage::kContact);
  constraints_.contacts().set(contacts, finder);
  std::size_t known = 0;
  Progress all;
  while (true) {
    if (contacts != nullptr) {
      beginContacts(inertia_.inverse(), std::abs(attempt.scale()), attempt.ratio, known, *contacts, constraints_.next);
      constraints_.settleGuide();
      known = contacts->size();
      if (known > 0 && task.path == 0.0) task.path = plan.h * std::sqrt(meanSquare(attempt.state.velocity));
    }
    SweepOutcome solved = sweeps_.run(task, attempt.clock);
    all.sweeps += solved.sweeps;
    all.end = solved.end;
    all.predicted_violation = std::max(all.predicted_violation, solved.predicted_violation);
    all.settled = solved.within;
    all.late = all.late || (solved.end == SweepEnd::kOutOfTime && !solved.within);
    if (contacts == nullptr) return all;
    if (free_ && !last_resort && attempt.start.keep == nullptr && !pressesOnObstacle(*contacts)) {
      keepMomentum(attempt.start);
      all.settled = solved.within = solved.within && sweeps_.linksHold();
    }
    if (!solved.within && (!last_resort || all.late || solved.end == SweepEnd::kDiverged)) return all;
    const ContactFinder::Verdict verdict = finder->verify(from, next, solved.within);
    attempt.clock.lap(Stage::kContact);
    if (verdict == ContactFinder::Verdict::kClear) return all;
    all.late = all.late || attempt.clock.late();
    if (!all.late && verdict == ContactFinder::Verdict::kMore && solved.within) continue;
    all.crossed = true;
    all.settled = false;
    if (last_resort && !all.late) finder->hold(from, constraints_.next);
    attempt.clock.lap(Stage::kContact);
    return all;
  }
}

// Rods alone do no work in steady motion if they pull along their directions half way between the velocities.
bool Step::needsEnergyCheck(const Attempt& attempt, const Progress& progress) const noexcept {
  return left_off_ || anyPushes(contacts()) || constraints_.stringsAct() || attempt.scheme.rules().follows ||
         !EnergyAccount::isSmall(progress.predicted_violation);
}

// Eq. (5). Decides whether the substep may be accepted: it makes no energy. Contacts with obstacles alone need no
// check: they are asked for their distance at the end, and their forces do no work but against motion. Those of the
// cloth with itself keep the plane of the start. And what the last substep left off is corrected in this one, which is
// no motion.
void Step::judge(const Attempt& attempt, Progress& progress, SubstepOutcome& outcome) noexcept {
  const bool last_resort = attempt.plan.isLastResort();
  const bool touches = anyPushes(contacts());
  const EnergyAccount::Drive drive{std::max(constraints_.distances().speed(), fastestSurface(contacts())),
                                   fastestDrive(contacts(), attempt.plan.h),
                                   2.0 * (constraints_.distances().elasticWork(attempt.start, constraints_.next) +
                                          constraints_.distances().drivenWork(attempt.start, constraints_.next)) +
                                       (constraints_.guide() != nullptr ? constraints_.guide()->energy() : 0.0)};
  // What moving pins and obstacles put into jammed cloth by its contacts is more than the account knows of.
  const bool driven = touches && (last_resort_.pinsMove() || drive.moving > 0.0);
  if (progress.late || (last_resort && !driven)) {
    progress.energy.most = account_.most(attempt.scheme.rules(), attempt.start, constraints_.next, drive);
  } else if (progress.settled && (!touches || left_off_ || pressesOnItself(contacts())) &&
             needsEnergyCheck(attempt, progress)) {
    const double can_hold =
        2.0 * constraints_.canHold(attempt.plan.h, stretch_tolerance_, stretch_tolerance_ * smallest_rest_);
    progress.energy = account_.entryOf(attempt.scheme.rules(), attempt.start, constraints_.next, drive, can_hold);
    const double made = progress.energy.made;
    if (made > account_.fromTolerance(attempt.plan.h) &&
        made > 2.0 * constraints_.heldBeyond(attempt.state.position, attempt.plan.h, stretch_tolerance_))
      progress.settled = false;
  }
  // Where an obstacle arrives fast, only the substep that touches it tells how short it should have been.
  outcome.longest_step = longestStep(contacts(), attempt.plan.h, smallest_rest_);
  if (attempt.plan.may_be_shorter && attempt.plan.h > kTooLong * outcome.longest_step) progress.settled = false;
  outcome.sweeps = progress.sweeps;
  outcome.touches = touches;
  outcome.settled = progress.settled;
  outcome.late = progress.late;
}

// End of the last resort: moves along the path as far as the links allow.
void Step::boundPath(const Attempt& attempt, const Progress& progress, SubstepOutcome& outcome) noexcept {
  Field3& next = constraints_.next;
  const bool verified = attempt.finder == nullptr || !progress.late;
  if (progress.end == SweepEnd::kDiverged || !verified || !isWithinNumbers(next)) {
    next = last_resort_.follows();
    outcome.share = 0.0;
  } else {
    const LastResort::Bound bound = last_resort_.bound(inertia_.inverse(), kBoundShare * stretch_tolerance_, next);
    outcome.share = bound.share;
    outcome.momentum_cut += bound.moment / attempt.plan.h;
  }
  // A shortened path, or one bounded on moving pins, is not the one that was verified. If it crosses something, the
  // cloth stays where it is, with its pins.
  if ((progress.crossed || (outcome.share < 1.0 && last_resort_.pinsMove())) && attempt.finder != nullptr &&
      attempt.finder->verify(attempt.state.position, next, true) != ContactFinder::Verdict::kClear) {
    next = attempt.state.position;
    outcome.share = 0.0;
    outcome.pins_wait = true;
  }
}

// Eq. (6).
void Step::accept(const Attempt& attempt, const Progress& progress, SubstepOutcome& outcome) noexcept {
  const SubstepPlan& plan = attempt.plan;
  ClothState& state = attempt.state;
  NodeInertia::Tensions& tensions = inertia_.tensions();
  outcome.scale = tensions.scale = attempt.scale();
  outcome.kick = attempt.kick;
  tensions.heaviest = constraints_.commit(attempt.start, plan.tells_turning, state, tensions.load);
  state.velocity_age = attempt.scheme.rules().age * plan.h;
  if (std::isfinite(progress.energy.most)) account_.bound(progress.energy.most, state.velocity);
  account_.setHeld(progress.energy.held);
  left_off_ = progress.end != SweepEnd::kConverged || plan.isLastResort();
  if (elastic_ != nullptr) outcome.dissipated = elastic_->commit(state.position);
  outcome.omega_squared = inertia_.omegaSquared();
  if (!anyPushes(contacts()) && !constraints_.stringsPull()) outcome.turning = turning(outcome.kick);
  // Such a substep also moved links to their lengths, which is no motion: project the velocities.
  if ((progress.end != SweepEnd::kConverged || plan.isLastResort()) && !progress.late) {
    if (constraints_.guide() != nullptr) constraints_.guide()->beginRates(state, 0.0, state.velocity);
    projectVelocity(state.position, 0.0, state.velocity);
  }
}

// ---- Sums over the cloth

// Mean square of the nodes' velocities relative to their mean [m^2/s^2].
double Step::meanSquare(const Field3& velocity) const noexcept {
  const auto nodes = static_cast<double>(pattern_.grid.nodeCount());
  Vec3 sum = Vec3::Zero();
  double squares = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    sum += velocity.at(n);
    squares += velocity.at(n).squaredNorm();
  }
  return std::max(0.0, squares / nodes - (sum / nodes).squaredNorm());
}

// How fast the rods change their motion [1/s]: sqrt(|a_b - a_a| / l), RMS over all rods, which is the rate of turn
// where that is steady. The forces acted for `kick` [s] in the last substep.
double Step::turning(double kick) const noexcept {
  return std::sqrt(std::sqrt(constraints_.turning() / ((pattern_.grid.rows - 1) * pattern_.grid.columns)) /
                   std::abs(kick));
}

// For cloth without pins: removes the momentum that the solve has added, by a rigid motion.
void Step::keepMomentum(const SubstepStart& start) noexcept {
  const Field3& from = start.state.position;
  Field3& next = constraints_.next;
  const auto missing = [&] {
    Momentum sum;
    for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
      const Vec3 wanted = start.state.velocity.at(n) + start.kick * pattern_.inverse_mass[n] * start.force.at(n);
      const Vec3 p = pattern_.mass[n] * (wanted - (next.at(n) - from.at(n)) / start.h);
      sum.linear += p;
      sum.angular += from.at(n).cross(p);
    }
    return sum;
  };
  const RigidMotion::Displacement carry = rigidMotion(pattern_, from, missing()).over(start.h);
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.mass[n] > 0.0) next.set(n, carry(next.at(n)));
  }
  // A rotation by a small angle leaves an error of second order. This correction is no rotation: where links turn far
  // in the substep it changes their lengths, so it has to be judged with them.
  const RigidMotion rest = rigidMotion(pattern_, from, missing());
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.mass[n] > 0.0) next.add(n, start.h * rest.at(from.at(n)));
  }
}

}  // namespace curtain
