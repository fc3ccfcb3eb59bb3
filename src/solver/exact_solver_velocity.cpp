// SPDX-License-Identifier: BSD-3-Clause
//
// The solver's velocities: at the time of the positions, free of what would change the links' lengths, and bounded where
// links can't hold.
#include <algorithm>
#include <cmath>

#include "cloth/free_body.h"
#include "forces/air_damping.h"
#include "solver/exact_solver.h"

namespace curtain {
namespace {

// Rounds of the linear velocity projection.
constexpr int kVelocityRounds = 2;
// With contacts, whose rows are damped; until the rate is this share of what it was.
constexpr int kContactRounds = 8;
constexpr double kContactRate = 1e-3;
constexpr double kVelocityDamping = 1e-4;
constexpr double kVelocityReduction = 1e-3;
constexpr int kVelocityIterations = 24;

}  // namespace

// Twice the kinetic energy the nodes would have without links [J].
double ExactSolver::predictedKinetic(const SubstepStart& start) const noexcept {
  double sum = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    const double w = inertia_.inverse()[n];
    const double keep = start.keep != nullptr ? (*start.keep)[n] : 1.0;
    const Vec3 velocity = keep * start.state.velocity.at(n) + start.kick * w * start.force.at(n);
    sum += inertia_.masses()[n] > 0.0 ? pattern_.mass[n] * velocity.squaredNorm() : 0.0;
  }
  return sum;
}

// Links that hold do no work; where they can't hold (a straight row between two pins under load) what is left over would
// become motion.
void ExactSolver::boundKinetic(double most, Field3& velocity) const noexcept {
  double sum = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) sum += pattern_.mass[n] * velocity.at(n).squaredNorm();
  if (!(sum > most)) return;
  const double share = std::sqrt(most / sum);
  for (Field* component : {&velocity.x, &velocity.y, &velocity.z}) {
    for (double& v : *component) v *= share;
  }
}

// Of a cloth that nothing holds: what the solve has added to its momentum is taken out of the whole.
void ExactSolver::keepMomentum(const SubstepStart& start) noexcept {
  const Field3& from = start.state.position;
  Momentum missing;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    const Vec3 wanted = start.state.velocity.at(n) + start.kick * pattern_.inverse_mass[n] * start.force.at(n);
    const Vec3 p = pattern_.mass[n] * (wanted - (next_.at(n) - from.at(n)) / start.h);
    missing.linear += p;
    missing.angular += from.at(n).cross(p);
  }
  const RigidMotion motion = rigidMotion(pattern_, from, missing);
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.mass[n] > 0.0) next_.add(n, start.h * motion.at(from.at(n)));
  }
}

void ExactSolver::currentVelocities(const ClothState& state, const NodeForces& forces,
                                    const Contacts* contacts, Field3& out) noexcept {
  const double age = state.velocity_age;
  const std::size_t size = pattern_.grid.size();
  for (std::size_t n = 0; n < size; ++n) {
    const double w = inertia_.masses()[n];
    const DampedStep step = forces.has_damping ? dampedStep(forces.damping[n], w, age) : DampedStep{1.0, 1.0};
    out.set(n, step.keep * state.velocity.at(n) + age * step.gain * w * forces.force->at(n));
  }
  if (age == 0.0) return;
  projectVelocity(state.position, contacts, age / inertia_.tensions().scale, out);
}

// Takes out of the velocities what would change the lengths of rods and of links that pull, and what contacts forbid, from
// where a share of the last substep's forces between nodes leads: friction goes on as it was, and at rest nothing is left to
// do. A free cloth keeps its momentum.
void ExactSolver::projectVelocity(const Field3& position, const Contacts* contacts, double share, Field3& out) noexcept {
  const bool keeps = free_ && !held_.any() && (contacts == nullptr || !pressesOnObstacle(*contacts));
  const Momentum before = keeps ? momentumOf(pattern_, position, out) : Momentum();
  projectOnConstraints(position, contacts, share, out);
  if (!keeps) return;
  const Momentum after = momentumOf(pattern_, position, out);
  const RigidMotion motion =
      rigidMotion(pattern_, position, {before.linear - after.linear, before.angular - after.angular});
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.mass[n] > 0.0) out.add(n, motion.at(position.at(n)));
  }
}

void ExactSolver::projectOnConstraints(const Field3& position, const Contacts* contacts, double share, Field3& out) noexcept {
  setWarpDirections(pattern_.grid, position, warp_.direction);
  const LineSolve warp{pattern_, inertia_.masses(), warp_, out, held_.movingSpan()};
  const auto solveRods = [&] {
    forEachBlock([&](int block) { warpProjectVelocity(warp, scratch_, block); });
  };
  if (share > 0.0) {
    // Blocks that are left out keep theirs: they are to be the same in both buffers (exact_solver_hold.cpp).
    forEachBlock([&](int block) {
      for (int i = 0; i < pattern_.grid.rows; ++i) {
        const std::size_t first = pattern_.grid.row(i) + static_cast<std::size_t>(block) * kLane;
        for (std::size_t n = first; n < first + kLane; ++n) warp_.multiplier[n] = share * last_warp_[n];
      }
      applyWarpMultipliers(warp, block);
    });
  }
  const bool presses = contacts != nullptr && std::any_of(contacts->begin(), contacts->end(),
                                                          [](const Contact& contact) { return contact.pushes(); });
  if (!weft_pulls_ && !presses) {
    solveRods();
    return;
  }
  LinkSet& links = weft_;
  const LineSolve weft{pattern_, inertia_.masses(), links, out, held_.movingSpan()};
  if (weft_pulls_) {
    std::copy(last_weft_.begin(), last_weft_.end(), links.multiplier.begin());  // which links pull
  }
  setAllWeftDirections(position);
  if (share > 0.0) {
    for (std::size_t n = 0; n < pattern_.grid.size(); ++n) change_[n] = share * links.multiplier[n];
    for (int i = 0; i < pattern_.grid.rows; ++i) pullWeft(weft, i, change_);
    for (std::size_t n = 0; contacts != nullptr && n < contacts->size(); ++n) {
      const Contact& contact = (*contacts)[n];
      if (contact.pushes()) contact.move(inertia_.masses(), share * (contact.push * contact.normal + contact.slide), out);
    }
  }
  solveRods();
  net_.begin(position, inertia_.masses(), held_.movingSpan());
  double first_rate = 0.0;
  for (int round = 0; round < (presses ? kContactRounds : kVelocityRounds); ++round) {
    double rate = worstOfRows([&](int i) { return measureWeftRates(weft, i, violation_, active_); });
    if (presses) rate = std::max(rate, contactRate(*contacts, out) / mean_rest_);
    if (round == 0) first_rate = rate;
    if (rate == 0.0 || (presses && round > 0 && rate <= kContactRate * first_rate)) break;
    net_.solve(violation_, active_, {presses ? contacts : nullptr, &out, true},
               {rate * mean_rest_, kVelocityDamping, kVelocityReduction, kVelocityIterations}, change_);
    for (int i = 0; i < pattern_.grid.rows; ++i) pullWeft(weft, i, change_);
    if (presses) {
      net_.forEachContactChange([&](std::uint32_t index, double push, const Vec3& slide) {
        const Contact& contact = (*contacts)[index];
        contact.move(inertia_.masses(), push * contact.normal + slide, out);
      });
    }
    solveRods();
  }
  if (weft_pulls_) std::fill(links.multiplier.begin(), links.multiplier.end(), 0.0);
}

}  // namespace curtain
