// SPDX-License-Identifier: BSD-3-Clause
//
// A substep of the exact schemes as a whole: solved, verified, taken.
#include <algorithm>
#include <cmath>

#include "cloth/wide.h"
#include "solver/constants.h"
#include "solver/exact_solver.h"

namespace curtain {
namespace {

bool isWithinNumbers(const Field3& position) noexcept {
  const auto within = [](const Field& values) {
    // The other way round NaN would pass.
    return std::all_of(values.begin(), values.end(), [](double value) { return std::abs(value) <= kBeyond; });
  };
  return within(position.x) && within(position.y) && within(position.z);
}

}  // namespace

// Solves, and solves again with what the finder has to add, until nothing goes through anything or that does not help.
ExactSolver::Progress ExactSolver::solveAndVerify(const SubstepPlan& plan, const SubstepStart& start, const Field3& from,
                                                  double ratio, double weight_way, ContactFinder* finder,
                                                  StageClock& clock) noexcept {
  Contacts* contacts = nullptr;
  std::size_t known = 0;
  int looks = 0;
  if (finder != nullptr) {
    contacts = &finder->begin(from, next_, plan.h);
    clock.lap(Stage::kContact);
  }
  Progress all;
  while (true) {
    if (contacts != nullptr) {
      if (beginContacts(inertia_.inverse(), ratio, known, *contacts, next_)) newton_begun_ = false;
      known = contacts->size();
    }
    const Progress progress = solveConstraints(plan, start.state.position, weight_way, contacts, clock);
    all.sweeps += progress.sweeps;
    all.settled = progress.settled;
    all.left_over = progress.left_over;
    all.late = all.late || (progress.late && !progress.settled);
    all.contacts = contacts;
    if (free_ && !plan.last_resort && !held_.any() && contacts != nullptr && start.keep == nullptr && !pressesOnObstacle(*contacts)) keepMomentum(start);
    all.found = progress.settled || progress.found;
    if (contacts == nullptr || !(progress.settled || (plan.last_resort && progress.found && !all.late))) return all;
    const ContactFinder::Verdict verdict = finder->verify(from, next_, progress.settled);
    clock.lap(Stage::kContact);
    if (verdict == ContactFinder::Verdict::kClear) return all;
    newton_begun_ = false;
    all.late = all.late || clock.late();
    if (!all.late && verdict == ContactFinder::Verdict::kMore && (progress.settled || ++looks < kHopelessLooks)) continue;
    all.crossed = true;
    all.settled = false;
    if (plan.last_resort && !all.late && !held_.any()) finder->hold(from, next_);
    clock.lap(Stage::kContact);
    return all;
  }
}

// Adds what the strings pull to the nodes' loads; returns the largest load over its mass.
CURTAIN_WIDE double ExactSolver::loadStrings() noexcept {
  const Grid& grid = pattern_.grid;
  const auto last = static_cast<std::size_t>(grid.columns) - 1;
  double worst = 0.0;
  for (int i = 0; i < grid.rows; ++i) {
    const std::size_t row = grid.row(i);
    const double* const f = weft_.multiplier.data() + row;
    const double* const w = pattern_.inverse_mass.data() + row;
    double* const load = inertia_.tensions().load.data() + row;
    load[last] += grid.closed ? f[last] + f[0] : f[last];
    worst = std::max(worst, load[last] * w[last]);
#pragma omp simd reduction(max : worst)
    for (std::size_t j = 0; j < last; ++j) {
      load[j] += f[j] + f[j + 1];
      const double heaviest = load[j] * w[j];
      worst = worst > heaviest ? worst : heaviest;
    }
  }
  return worst;
}

// The substep is taken.
void ExactSolver::commit(const ClothState& base, double step, double velocity_age, bool bends, ClothState& state) noexcept {
  NodeInertia::Tensions& tensions = inertia_.tensions();
  const LineSolve warp{pattern_, inertia_.inverse(), warp_, next_, held_.movingSpan()};
  forEachBlock([&](int block) {
    block_motion_[static_cast<std::size_t>(block)] =
        warpFinish(warp, base.position, 1.0 / step, bends, state.velocity, tensions.load, block);
  });
  tensions.heaviest = 0.0;
  for (const WarpMotion& block : block_motion_) tensions.heaviest = std::max(tensions.heaviest, block.heaviest);
  weft_pulls_ = directions_set_ &&
                std::any_of(weft_.multiplier.begin(), weft_.multiplier.end(), [](double s) { return s != 0.0; });
  if (weft_pulls_) {
    tensions.heaviest = loadStrings();
    last_weft_ = weft_.multiplier;
  }
  std::swap(state.position, next_);  // where columns are held the two are equal
  std::swap(last_warp_, warp_.multiplier);
  state.velocity_age = velocity_age;
}

// How fast the rods change their motion, as the rate of a turn that would (RMS over all rods) [1/s]: sqrt(|a_b - a_a| / l),
// which is the rate of turn itself where that is steady. The forces acted for a time `kick` [s] in the last substep.
double ExactSolver::turning(double kick) const noexcept {
  double bent = 0.0;
  for (const WarpMotion& block : block_motion_) bent += block.bent;
  return std::sqrt(std::sqrt(bent / ((pattern_.grid.rows - 1) * pattern_.grid.columns)) / std::abs(kick));
}

// A string has snapped taut in this substep, or something has met something.
bool ExactSolver::struck(const Contacts* contacts) const noexcept {
  for (std::size_t n = 0; directions_set_ && n < pattern_.grid.size(); ++n) {
    if (weft_.multiplier[n] > 0.0 && !(weft_pulls_ && last_weft_[n] > 0.0)) return true;
  }
  return contacts != nullptr && std::any_of(contacts->begin(), contacts->end(), [](const Contact& contact) {
           return contact.pushes() && !contact.pressed;
         });
}

// The last resort's prediction: velocities with all that forces do, cut.
void ExactSolver::cutPrediction(const SubstepPlan& plan, const NodeForces& forces, const ClothState& state, double kick,
                                SubstepOutcome& outcome) noexcept {
  const Field* const keep = inertia_.keep();
  const Field& w = inertia_.inverse();
  base_.position = state.position;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    const Vec3 v = state.velocity.at(n);
    base_.velocity.set(n, w[n] > 0.0 ? Vec3((keep != nullptr ? (*keep)[n] : 1.0) * v + kick * w[n] * forces.force->at(n)) : v);
  }
  outcome.momentum_cut += last_resort_.cut(base_.position, w, plan.h, plan.reach, base_.velocity);
}

// The last resort's end: as far along the path as links hold.
void ExactSolver::boundPath(const Progress& progress, double h, SubstepOutcome& outcome) noexcept {
  const bool verified = progress.contacts == nullptr || !progress.late;
  if (!progress.found || !verified || !isWithinNumbers(next_)) {
    next_ = last_resort_.follows();
    outcome.share = 0.0;
    return;
  }
  const LastResort::Bound bound = last_resort_.bound(inertia_.inverse(), kBoundShare * stretch_tolerance_, next_);
  outcome.share = bound.share;
  outcome.momentum_cut += bound.moment / h;
}

SubstepOutcome ExactSolver::substep(const SubstepPlan& plan, const NodeForces& forces, ContactFinder* finder,
                                    ClothState& state, StageClock& clock) noexcept {
  const bool leapfrog = plan.scheme == Scheme::kLeapfrog;
  SubstepOutcome outcome;
  double step = plan.h;
  const ClothState& base = setBase(plan.scheme, plan.h, state, step);
  const double kick = leapfrog ? state.velocity_age + 0.5 * step : step + state.velocity_age;
  const double scale = step * kick;
  inertia_.set(forces, kick, scale, plan.most_phase, !leapfrog);
  const bool falls = forces.weight_only && inertia_.massesAlone() && !plan.last_resort;
  if (plan.last_resort) cutPrediction(plan, forces, state, kick, outcome);
  const SubstepStart start{plan.last_resort ? base_ : base, plan.last_resort ? no_force_ : *forces.force, falls ? &forces.gravity : nullptr,
                           plan.last_resort ? nullptr : inertia_.keep(), kick, step};
  const double ratio = begin(plan, start, scale);
  clock.lap(Stage::kPredict);
  const double weight_way = forces.gravity.norm() * plan.h * plan.h;
  Progress progress = solveAndVerify(plan, start, state.position, ratio, weight_way, finder, clock);
  if (plan.scheme == Scheme::kBdf2 && struck(progress.contacts)) {
    single_steps_ = kStepsAfterBlow;
    if (older_h_ != 0.0) {  // made again, from one step
      older_h_ = 0.0;
      if (!weft_pulls_) std::fill(weft_.multiplier.begin(), weft_.multiplier.end(), 0.0);
      SubstepOutcome again = substep(plan, forces, finder, state, clock);
      again.sweeps += progress.sweeps;
      return again;
    }
  }
  // Links let nodes lie in many ways, and a long step may find one that is far from where they were; and strings that have become
  // taut in it may pull harder than it is stable for.
  const bool may_jump = (plan.scheme == Scheme::kBdf2 || (leapfrog && directions_set_)) && !plan.last_resort;
  const bool alone = progress.contacts == nullptr || !anyPushes(*progress.contacts);
  bool adds = false;
  if (may_jump && alone && progress.settled) {
    Kinetic kinetic = kineticOf(start);
    if (kinetic.stepped > kMostAdded * kinetic.predicted) kinetic.driven = drivenKinetic(start.state.velocity);
    adds = kinetic.stepped > kinetic.most(kMostAdded);
    // What its links may lack of their lengths would be more still in a shorter one.
    const bool jumps = kinetic.stepped > kinetic.most(plan.scheme == Scheme::kBdf2 ? kMostAdded : kMostKinetic) &&
                       kinetic.stepped > kinetic.most(1.0) + fromTolerance(step);
    if (jumps) progress.settled = false;
  }
  if (held_.any()) {
    const bool stuck = progress.crossed || (plan.last_resort && !progress.settled);
    const LinkSet* const strings = directions_set_ ? &weft_ : nullptr;
    outcome.disturbed = held_.disturbedBy(strings, progress.contacts, 1.0 / scale, forces.gravity.norm(), stuck);
  }
  outcome.sweeps = progress.sweeps;
  outcome.settled = progress.settled;
  if (plan.last_resort && !progress.settled) boundPath(progress, plan.h, outcome);
  // Bounded, cloth on moving pins goes another path than was verified. Where that leads through something even the pins wait.
  if (outcome.share < 1.0 && last_resort_.pinsMove() && finder != nullptr &&
      finder->verify(state.position, next_, true) != ContactFinder::Verdict::kClear) {
    next_ = state.position;
    outcome.share = 0.0;
    outcome.pins_wait = true;
  }
  outcome.late = progress.late;
  outcome.accepted = !outcome.disturbed && (progress.settled || plan.last_resort);
  if (outcome.accepted) {
    outcome.scale = inertia_.tensions().scale = scale;
    outcome.kick = kick + (plan.h - step);  // bdf2's base holds the rest of what forces do
    if (single_steps_ > 0) --single_steps_;
    if (plan.scheme == Scheme::kBdf2 && single_steps_ == 0) {
      older_position_ = state.position;
      older_velocity_ = state.velocity;
      older_h_ = plan.h;
    } else {
      older_h_ = 0.0;
    }
    const bool bounded = ((plan.scheme == Scheme::kImplicit || plan.last_resort) && alone) || adds || progress.late;
    Kinetic kinetic;
    if (bounded) {
      kinetic = kineticOf(start);
      kinetic.driven = drivenKinetic(start.state.velocity);
    }
    commit(start.state, step, leapfrog ? 0.5 * step : 0.0, plan.tells_turning, state);
    if (bounded) boundKinetic(kinetic.most(1.0), state.velocity);
    outcome.omega_squared = inertia_.omegaSquared();
    if (alone && !weft_pulls_) outcome.turning = turning(outcome.kick);
    const double fastest = progress.contacts != nullptr ? fastestSurface(*progress.contacts) : 0.0;
    if (fastest > 0.0) outcome.longest_step = kMostWayOfSurface * smallest_rest_ / fastest;
    // The way such a substep has gone is not all motion: what pulls its links further is taken out.
    if ((progress.left_over || plan.last_resort) && !progress.late) projectVelocity(state.position, progress.contacts, 0.0, state.velocity);
  }
  if (directions_set_ && (!outcome.accepted || !weft_pulls_)) std::fill(weft_.multiplier.begin(), weft_.multiplier.end(), 0.0);
  clock.lap(Stage::kFinish);
  return outcome;
}

}  // namespace curtain
