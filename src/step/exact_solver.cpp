// SPDX-License-Identifier: BSD-3-Clause
#include "step/exact_solver.h"

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

ExactSolver::ExactSolver(const ClothPattern& pattern, const SolverParts& parts, double stretch_tolerance,
                         int max_sweeps, const Workers& workers)
    : pattern_(pattern),
      free_(isFree(pattern)),
      stretch_tolerance_(stretch_tolerance),
      smallest_rest_(shortestLink(pattern)),
      inertia_(pattern),
      elastic_(parts.elastic),
      constraints_(pattern, parts, kInnerTolerance * stretch_tolerance, inertia_, workers),
      sweeps_(constraints_, inertia_, stretch_tolerance, stretch_tolerance * smallest_rest_, max_sweeps),
      account_(pattern, inertia_, stretch_tolerance, constraints_.middleRest()),
      last_resort_(pattern, constraints_.distances()) {}

void ExactSolver::takeStretchTolerance(double tolerance) noexcept {
  stretch_tolerance_ = tolerance;
  constraints_.takeTolerance(kInnerTolerance * tolerance);
  sweeps_.takeTolerances(tolerance, tolerance * smallest_rest_);
  account_.takeStretchTolerance(tolerance);
}

void ExactSolver::reset() noexcept {
  account_.setHeld(0.0);
  constraints_.reset();
  inertia_.forget();
}

void ExactSolver::takePins() noexcept {
  free_ = isFree(pattern_);
  inertia_.takePins();
  if (elastic_ != nullptr) elastic_->takePins();
  constraints_.takePins();
  account_.takePins();
}

void ExactSolver::repinned() noexcept {
  constraints_.slackenBetweenPins();
  inertia_.tensions().heaviest = inertia_.heaviest();
  account_.setHeld(0.0);
}

Scheme& ExactSolver::schemeOf(SchemeKind kind) noexcept {
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

SubstepOutcome ExactSolver::substep(const SubstepPlan& plan, const NodeForces& forces, ContactFinder* finder,
                                    ClothState& state, StageClock& clock) noexcept {
  SubstepOutcome outcome;
  const Attempt attempt = predict(plan, forces, finder, state, clock, outcome);
  Progress progress = solveAndVerify(attempt);
  judge(attempt, progress, outcome);
  if (plan.isLastResort() && !progress.settled) boundPath(attempt, progress, outcome);
  outcome.accepted = progress.settled || plan.isLastResort();
  if (outcome.accepted) take(attempt, progress, outcome);
  constraints_.end(outcome.accepted);
  if (!outcome.accepted) constraints_.distances().resume(state);
  clock.lap(Stage::kFinish);
  return outcome;
}

// Schemes with velocities at the end of the step use forces that act until then; leapfrog's act for half a step less.
ExactSolver::Attempt ExactSolver::predict(const SubstepPlan& plan, const NodeForces& forces, ContactFinder* finder,
                                          ClothState& state, StageClock& clock, SubstepOutcome& outcome) noexcept {
  Scheme& scheme = schemeOf(plan.scheme);
  const Scheme::Rules& rules = scheme.rules();
  const double kick = state.velocity_age + (1.0 - rules.age) * plan.h;
  const double scale = plan.h * kick;
  inertia_.setGuided(!plan.isLastResort());
  inertia_.set(forces, kick, scale, plan.most_phase, rules.backward);
  if (elastic_ != nullptr) elastic_->begin(inertia_, inertia_.inverse(), scale, !rules.follows);
  // Warm start only along fixed directions: with present directions old tensions diverge where rods have turned much.
  const double before = inertia_.tensions().scale;
  const double ratio = !rules.follows && before != 0.0 ? scale / before : 0.0;
  const Scheme::Task task{plan, kick, forces, inertia_, elastic_};
  const Attempt attempt{plan, forces, finder, state, clock, scheme, kick, ratio, scheme.start(task, state, outcome)};
  constraints_.begin(attempt.start, state, ratio, !plan.isLastResort());
  clock.lap(Stage::kPredict);
  return attempt;
}

// Mean square of the nodes' velocities relative to their mean [m^2/s^2].
double ExactSolver::meanSquare(const Field3& velocity) const noexcept {
  const auto nodes = static_cast<double>(pattern_.grid.nodeCount());
  Vec3 sum = Vec3::Zero();
  double squares = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    sum += velocity.at(n);
    squares += velocity.at(n).squaredNorm();
  }
  return std::max(0.0, squares / nodes - (sum / nodes).squaredNorm());
}

// Solves, and solves again with the contacts that verification adds, until nothing is crossed or that does not help.
ExactSolver::Progress ExactSolver::solveAndVerify(const Attempt& attempt) noexcept {
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
  Contacts* const contacts = finder != nullptr ? &finder->begin(from, next, plan.h) : nullptr;
  if (finder != nullptr) attempt.clock.lap(Stage::kContact);
  constraints_.contacts().set(contacts);
  std::size_t known = 0;
  Progress all;
  while (true) {
    if (contacts != nullptr) {
      beginContacts(inertia_.inverse(), std::abs(attempt.scale()), attempt.ratio, known, *contacts, constraints_.next);
      constraints_.settleGuide();
      known = contacts->size();
      if (known > 0 && task.path == 0.0) task.path = plan.h * std::sqrt(meanSquare(attempt.state.velocity));
    }
    const SweepOutcome solved = sweeps_.run(task, attempt.clock);
    all.sweeps += solved.sweeps;
    all.end = solved.end;
    all.predicted_violation = std::max(all.predicted_violation, solved.predicted_violation);
    all.settled = solved.within;
    all.late = all.late || (solved.end == SweepEnd::kOutOfTime && !solved.within);
    if (contacts == nullptr) return all;
    if (free_ && !last_resort && attempt.start.keep == nullptr && !pressesOnObstacle(*contacts))
      keepMomentum(attempt.start);
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
bool ExactSolver::needsEnergyCheck(const Attempt& attempt, const Progress& progress) const noexcept {
  const bool rods_alone = !anyPushes(contacts()) && !constraints_.stringsAct();
  return !rods_alone || attempt.scheme.rules().follows || !EnergyAccount::isSmall(progress.predicted_violation);
}

// Decides whether the substep may be accepted: it gains no energy.
void ExactSolver::judge(const Attempt& attempt, Progress& progress, SubstepOutcome& outcome) noexcept {
  const bool last_resort = attempt.plan.isLastResort();
  const bool touches = anyPushes(contacts());
  const double parts = constraints_.distances().speed();
  const EnergyAccount::Drive drive{std::max(parts, fastestSurface(contacts())),
                                   std::max(parts, fastestDrive(contacts(), attempt.state.position, attempt.plan.h)),
                                   2.0 * constraints_.distances().elasticWork(attempt.start, constraints_.next) +
                                       (constraints_.guide() != nullptr ? constraints_.guide()->energy() : 0.0)};
  if (progress.late || (last_resort && !touches)) {
    progress.energy.most = account_.most(attempt.scheme.rules(), attempt.start, constraints_.next, drive);
  } else if (!last_resort && progress.settled && needsEnergyCheck(attempt, progress)) {
    const double can_hold =
        2.0 * constraints_.canHold(attempt.plan.h, stretch_tolerance_, stretch_tolerance_ * smallest_rest_);
    progress.energy = account_.entryOf(attempt.scheme.rules(), attempt.start, constraints_.next, drive, can_hold);
    const double made = progress.energy.made;
    if (made > account_.fromTolerance(attempt.plan.h) &&
        made > 2.0 * constraints_.heldBeyond(attempt.state.position, attempt.plan.h, stretch_tolerance_))
      progress.settled = false;
  }
  outcome.sweeps = progress.sweeps;
  outcome.touches = touches;
  outcome.settled = progress.settled;
  outcome.late = progress.late;
}

// End of the last resort: moves along the path as far as the links allow.
void ExactSolver::boundPath(const Attempt& attempt, const Progress& progress, SubstepOutcome& outcome) noexcept {
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

void ExactSolver::take(const Attempt& attempt, const Progress& progress, SubstepOutcome& outcome) noexcept {
  const SubstepPlan& plan = attempt.plan;
  ClothState& state = attempt.state;
  NodeInertia::Tensions& tensions = inertia_.tensions();
  outcome.scale = tensions.scale = attempt.scale();
  outcome.kick = attempt.kick;
  tensions.heaviest = constraints_.commit(attempt.start, plan.tells_turning, state, tensions.load);
  state.velocity_age = attempt.scheme.rules().age * plan.h;
  if (std::isfinite(progress.energy.most)) account_.bound(progress.energy.most, state.velocity);
  account_.setHeld(progress.energy.held);
  outcome.omega_squared = inertia_.omegaSquared();
  if (!anyPushes(contacts()) && !constraints_.stringsPull()) outcome.turning = turning(outcome.kick);
  const double fastest = fastestSurface(contacts());
  if (fastest > 0.0) outcome.longest_step = kMostSurfaceMotion * smallest_rest_ / fastest;
  // Such a substep also moved links to their lengths, which is no motion: project the velocities.
  if ((progress.end != SweepEnd::kConverged || plan.isLastResort()) && !progress.late) {
    if (constraints_.guide() != nullptr) constraints_.guide()->beginRates(state, 0.0, state.velocity);
    projectVelocity(state.position, 0.0, state.velocity);
  }
}

// How fast the rods change their motion [1/s]: sqrt(|a_b - a_a| / l), RMS over all rods, which is the rate of turn
// where that is steady. The forces acted for `kick` [s] in the last substep.
double ExactSolver::turning(double kick) const noexcept {
  return std::sqrt(std::sqrt(constraints_.turning() / ((pattern_.grid.rows - 1) * pattern_.grid.columns)) /
                   std::abs(kick));
}

// For cloth without pins: takes what the solve has added to the momentum out again, by a rigid motion.
void ExactSolver::keepMomentum(const SubstepStart& start) noexcept {
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
  // A rotation by a small angle leaves an error of second order; this correction changes lengths by fourth order.
  const RigidMotion rest = rigidMotion(pattern_, from, missing());
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.mass[n] > 0.0) next.add(n, start.h * rest.at(from.at(n)));
  }
}

void ExactSolver::currentVelocities(const ClothState& state, const NodeForces& forces, const Contacts* contacts,
                                    Field3& out) noexcept {
  const double age = state.velocity_age;
  double elastic = 0.0;
  const Field3* const stiff = elasticAt(state.position, elastic);
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    const double w = inertia_.masses()[n];
    const DampedStep step = forces.has_damping ? dampedStep(forces.damping[n], w, age) : DampedStep{1.0, 1.0};
    const Vec3 force = stiff != nullptr ? Vec3(forces.force->at(n) + stiff->at(n)) : forces.force->at(n);
    out.set(n, step.keep * state.velocity.at(n) + age * step.gain * w * force);
  }
  if (age == 0.0) return;
  if (constraints_.guide() != nullptr) constraints_.guide()->beginRates(state, age, out);
  constraints_.contacts().show(contacts);
  const double most = account_.most(out, fastestSurface(constraints_.contacts().all()));
  projectVelocity(state.position, age / inertia_.tensions().scale, out);
  account_.bound(most, out);
}

// From what a snapshot holds, so that it is the same after it.
const Field3* ExactSolver::elasticAt(const Field3& position, double& energy) noexcept {
  energy = 0.0;
  if (elastic_ == nullptr) return nullptr;
  elastic_->begin(inertia_, inertia_.masses(), inertia_.tensions().scale, true);
  return &elastic_->forceAt(position, energy);
}

void ExactSolver::copyPulls(const ClothState& state, const Contacts* contacts, Field3& out) noexcept {
  out.assign(pattern_.grid.size(), 0.0);
  const double scale = inertia_.tensions().scale;
  constraints_.contacts().show(contacts);
  if (scale != 0.0) constraints_.addPulls(state.position, 1.0 / scale, out);
  double elastic = 0.0;
  const Field3* const stiff = elasticAt(state.position, elastic);
  for (std::size_t n = 0; stiff != nullptr && n < pattern_.grid.size(); ++n) {
    out.add(n, inertia_.masses()[n] * stiff->at(n));
  }
}

// Keeps the momentum of cloth without pins.
void ExactSolver::projectVelocity(const Field3& position, double share, Field3& out) noexcept {
  const bool keeps = free_ && !pressesOnObstacle(contacts());
  const Momentum before = keeps ? momentumOf(pattern_, position, out) : Momentum();
  constraints_.project(position, share, out);
  if (!keeps) return;
  const Momentum after = momentumOf(pattern_, position, out);
  const RigidMotion motion =
      rigidMotion(pattern_, position, {before.linear - after.linear, before.angular - after.angular});
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.mass[n] > 0.0) out.add(n, motion.at(position.at(n)));
  }
}

void ExactSolver::book(const ClothState& state, const NodeForces& forces, const SubstepOutcome& outcome) noexcept {
  account_.bookForces(state.velocity, forces, elastic_ != nullptr ? &elastic_->sum() : nullptr, outcome.kick);
  const double per_h = outcome.scale != 0.0 ? outcome.kick / outcome.scale : 0.0;
  const Grid& grid = pattern_.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      if (pattern_.pinned[n] == kPinned && !state.velocity.at(n).isZero(0.0))
        account_.bookPin(per_h * pullAt(i, j), state.velocity.at(n));
    }
  }
  for (std::size_t n = grid.row(grid.rows); n < grid.size(); ++n) {
    if (pattern_.pinned[n] == kPinned) account_.bookPin(per_h * distances().pullAt(n), state.velocity.at(n));
  }
  account_.bookElastic(distances().elasticWork());
  account_.bookDrive(distances().work(account_.before(), state.velocity, per_h));
  if (guide() != nullptr) account_.bookDrive(guide()->work(account_.before(), state.velocity, outcome.kick));
}

void ExactSolver::save(Memory& memory) const {
  constraints_.save(memory.constraints);
  memory.tensions = inertia_.tensions();
  memory.held = account_.held();
  if (constraints_.guide() != nullptr) constraints_.guide()->save(memory.guide);
}

void ExactSolver::restore(const Memory& memory) {
  constraints_.restore(memory.constraints);
  inertia_.tensions() = memory.tensions;
  account_.setHeld(memory.held);
  if (constraints_.guide() != nullptr) constraints_.guide()->restore(memory.guide);
}

}  // namespace curtain
