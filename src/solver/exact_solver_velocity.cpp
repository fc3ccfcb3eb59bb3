// SPDX-License-Identifier: BSD-3-Clause
//
// The solver's velocities: at the time of the positions, free of what would change the links' lengths, and bounded where
// links can't hold.
#include <algorithm>
#include <array>
#include <cmath>

#include "cloth/free_body.h"
#include "cloth/wide.h"
#include "forces/air_damping.h"
#include "solver/constants.h"
#include "solver/exact_solver.h"

namespace curtain {

// Links that hold do no work but what pins put in: seen from pins that go by at u the cloth has no more than before, so its sqrt of
// twice the kinetic energy grows by 2 u sqrt(M) at most. Pins that draw a flat string taut put in more, against what it bears; that
// is left out.
double ExactSolver::Kinetic::most(double share) const noexcept {
  const double root = std::sqrt(share * predicted) + 2.0 * std::sqrt(driven);
  return root * root;
}

// What links may lack of their lengths comes out of a substep as speed.
double ExactSolver::fromTolerance(double h) const noexcept {
  const double speed = stretch_tolerance_ * middle_rest_ / h;
  double mass = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) mass += inertia_.masses()[n] > 0.0 ? pattern_.mass[n] : 0.0;
  return mass * speed * speed;
}

// By lanes, so that the sums have one order, whatever the processor's width.
CURTAIN_WIDE ExactSolver::Kinetic ExactSolver::kineticOf(const SubstepStart& start) const noexcept {
  const std::size_t size = pattern_.grid.size();
  const Field3 &from = start.state.position, &velocity = start.state.velocity;
  const double* const mass = pattern_.mass.data();
  const double* const free = inertia_.masses().data();
  const double* const inverse = inertia_.inverse().data();
  // Read in any case, from where there is something: masked loads from nowhere cost a hundred times as much.
  const bool damped = start.keep != nullptr;
  const double* const keep = damped ? start.keep->data() : mass;
  const double per_step = 1.0 / start.h, kick = start.kick;
  std::array<double, kLane> stepped{}, predicted{};
  const auto add = [&](const Field& x_next, const Field& x_from, const Field& v_field, const Field& f_field) {
    const double *const x = x_next.data(), *const a = x_from.data(), *const v = v_field.data(), *const f = f_field.data();
    for (std::size_t n = 0; n < size; n += kLane) {
#pragma omp simd
      for (std::size_t l = 0; l < kLane; ++l) {
        const double whole = mass[n + l], m = free[n + l] > 0.0 ? whole : 0.0;
        const double made = per_step * (x[n + l] - a[n + l]);
        const double kept = keep[n + l];
        const double without = (damped ? kept : 1.0) * v[n + l] + kick * inverse[n + l] * f[n + l];
        stepped[l] += m * made * made;
        predicted[l] += m * without * without;
      }
    }
  };
  add(next_.x, from.x, velocity.x, start.force.x);
  add(next_.y, from.y, velocity.y, start.force.y);
  add(next_.z, from.z, velocity.z, start.force.z);
  Kinetic sum;
  for (std::size_t l = 0; l < kLane; ++l) {
    sum.stepped += stepped[l];
    sum.predicted += predicted[l];
  }
  return sum;
}

double ExactSolver::kineticOf(const Field3& velocity) const noexcept {
  double sum = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (inertia_.masses()[n] > 0.0) sum += pattern_.mass[n] * velocity.at(n).squaredNorm();
  }
  return sum;
}

// All of the cloth at the speed of its fastest pin.
double ExactSolver::drivenKinetic(const Field3& velocity) const noexcept {
  double mass = 0.0, fastest = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (inertia_.masses()[n] > 0.0) {
      mass += pattern_.mass[n];
    } else {
      fastest = std::max(fastest, velocity.at(n).squaredNorm());
    }
  }
  return mass * fastest;
}

// Where links can't hold (a straight row between two pins under load) what is left over would become motion.
void ExactSolver::boundKinetic(double most, Field3& velocity) const noexcept {
  const Field& inverse = inertia_.masses();
  const double sum = kineticOf(velocity);
  if (!(sum > most)) return;
  const double share = std::sqrt(most / sum);
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (inverse[n] > 0.0) velocity.set(n, share * velocity.at(n));  // pins go where they are told to
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
  Kinetic kinetic;
  kinetic.predicted = kineticOf(out);
  kinetic.driven = drivenKinetic(out);
  projectVelocity(state.position, contacts, age / inertia_.tensions().scale, out);
  // What links that can't hold pull is beyond all measure.
  if (contacts == nullptr || !anyPushes(*contacts)) boundKinetic(kinetic.most(1.0), out);
}

Vec3 ExactSolver::pullAt(int row, int column) const noexcept {
  const Grid& grid = pattern_.grid;
  const std::size_t n = grid.index(row, column);
  const auto stride = static_cast<std::size_t>(grid.stride);
  const bool last = column + 1 == grid.columns;
  const std::size_t right = last ? grid.index(row, 0) : n + 1;  // closed cloth: the first column's link closes the ring
  Vec3 pull = last_warp_[n + stride] * warp_.direction.at(n + stride) - last_warp_[n] * warp_.direction.at(n);
  if (!weft_pulls_) return pull;
  pull -= last_weft_[n] * weft_.direction.at(n);
  if (!last || grid.closed) pull += last_weft_[right] * weft_.direction.at(right);
  return pull;
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
  const bool presses = contacts != nullptr && anyPushes(*contacts);
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
    if (presses) rate = std::max(rate, contactRate(*contacts, out) / middle_rest_);
    if (round == 0) first_rate = rate;
    if (rate == 0.0 || (presses && round > 0 && rate <= kContactRate * first_rate)) break;
    net_.solve(violation_, active_, {presses ? contacts : nullptr, &out, true},
               {rate * middle_rest_, kVelocityDamping, kVelocityReduction, kVelocityIterations}, change_);
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
