// SPDX-License-Identifier: BSD-3-Clause
#include "step/schemes/last_resort.h"

#include <algorithm>
#include <cmath>

#include "step/constants.h"

namespace curtain {

LastResort::LastResort(const ClothPattern& pattern, const DistanceRows& distances)
    : Scheme({true, false, 0.5}), pattern_(pattern), distances_(distances) {
  const Grid& grid = pattern.grid;
  for (Field3* field : {&base_.position, &base_.velocity, &no_force_}) field->assign(grid.size(), 0.0);
  shortest_.assign(grid.size(), std::numeric_limits<double>::infinity());
  follows_.assign(grid.size(), 0.0);
  forEachLink(pattern, [&](std::size_t n, std::size_t other, double rest, bool) {
    shortest_[n] = std::min(shortest_[n], rest);
    shortest_[other] = std::min(shortest_[other], rest);
  });
  for (const DistanceRow& row : distances.all()) {
    for (const std::size_t n : {row.node, row.other}) {
      if (row.compliance == 0.0) shortest_[n] = std::min(shortest_[n], row.length);
    }
  }
}

// Calls visit(node, other, rest length, is a rod) for every link and row with a movable end.
template <typename Visit>
void LastResort::forEachBound(const Field& inverse, const Visit& visit) const {
  forEachLink(pattern_, [&](std::size_t n, std::size_t other, double rest, bool rod) {
    if (inverse[n] + inverse[other] > 0.0) visit(n, other, rest, rod);
  });
  for (const DistanceRow& row : distances_.all()) {
    if (row.holds && row.compliance == 0.0) visit(row.node, row.other, row.length, false);
  }
}

SubstepStart LastResort::start(const Task& task, const ClothState& state, SubstepOutcome& outcome) noexcept {
  const Field* const keep = task.inertia.keep();
  const Field& w = task.inertia.inverse();
  const Field3& outer = *task.forces.force;
  base_.position = state.position;
  base_.place = state.place;
  const auto accelerate = [&](const Field3& force, double sign) {
    for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
      if (w[n] > 0.0) base_.velocity.add(n, sign * task.kick * w[n] * force.at(n));
    }
    for (const std::size_t n : pattern_.guided) base_.velocity.set(n, Vec3::Zero());  // they stand still
  };
  const auto cutPath = [&] {
    outcome.momentum_cut += cut(base_.position, w, task.plan.h, task.plan.reach, base_.velocity);
  };
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n)
    base_.velocity.set(n, (keep != nullptr && w[n] > 0.0 ? (*keep)[n] : 1.0) * state.velocity.at(n));
  accelerate(outer, 1.0);
  cutPath();
  if (task.elastic != nullptr) {
    // Where the outer forces lead within the reach: the force of links many times too long has no bound.
    accelerate(outer, -1.0);
    accelerate(task.elastic->addAhead({base_, outer, nullptr, nullptr, task.kick, task.plan.h}, w), 1.0);
    cutPath();
  }
  return {base_, no_force_, nullptr, nullptr, task.kick, task.plan.h};
}

// Least-squares rigid motion of the nodes with prescribed velocity; false: there are none.
bool LastResort::rigidMotionOfPins(const Field3& position, const Field& inverse, const Field3& velocity,
                                   RigidMotion& motion) const noexcept {
  double pins = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (!pattern_.isThere(n) || inverse[n] > 0.0) continue;
    pins += 1.0;
    motion.centre += position.at(n);
    motion.drift += velocity.at(n);
  }
  if (pins == 0.0) return false;
  motion.centre /= pins;
  motion.drift /= pins;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  Vec3 spin = Vec3::Zero();
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (!pattern_.isThere(n) || inverse[n] > 0.0) continue;
    const Vec3 arm = position.at(n) - motion.centre;
    inertia += arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose();
    spin += arm.cross(velocity.at(n) - motion.drift);
  }
  motion.turn = turnOf(inertia, spin);
  return true;
}

double LastResort::cut(const Field3& position, const Field& inverse, double h, double reach,
                       Field3& velocity) noexcept {
  const auto isFinite = [](const Vec3& v) { return v.allFinite() && std::isfinite(v.squaredNorm()); };
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (!isFinite(velocity.at(n))) velocity.set(n, Vec3::Zero());
  }
  RigidMotion rigid;
  const bool pinned = rigidMotionOfPins(position, inverse, velocity, rigid);
  pins_move_ = pinned && !(rigid.drift.isZero(0.0) && rigid.turn.isZero(0.0));
  if (!pinned) rigid = rigidMotion(pattern_, position, momentumOf(pattern_, position, velocity));
  const RigidMotion::Displacement carry = rigid.over(h);
  double taken = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    const Vec3 from = position.at(n), v = velocity.at(n);
    if (!(inverse[n] > 0.0)) {
      follows_.set(n, from + h * v);
      continue;
    }
    const Vec3 follows = carry(from);
    follows_.set(n, pinned ? follows : from);
    const Vec3 carried = (follows - from) / h, own = v - carried;
    const double path = h * own.norm(), most = reach * shortest_[n];
    if (!(path > most)) continue;
    taken += pattern_.mass[n] * (1.0 - most / path) * own.norm();
    velocity.set(n, carried + most / path * own);
  }
  return taken;
}

// Relative overlengths of links (and underlengths of rods) with a movable end: largest and sum of squares.
LastResort::Misfit LastResort::misfitOf(const Field3& position, const Field& inverse) const noexcept {
  Misfit misfit;
  forEachBound(inverse, [&](std::size_t n, std::size_t other, double rest, bool rod) {
    const double over = (position.at(n) - position.at(other)).norm() / rest - 1.0;
    const double lacks = rod ? std::abs(over) : std::max(0.0, over);
    misfit.worst = std::max(misfit.worst, lacks);
    misfit.squares += lacks * lacks;
  });
  return misfit;
}

// The largest share <= most of a link's path within its bounds.
double LastResort::shareOf(std::size_t a, std::size_t b, double rest, bool rod, double allowed, double most,
                           const Field3& end) const noexcept {
  const Vec3 r = follows_.at(b) - follows_.at(a), d = end.at(b) - end.at(a) - r;
  const double longest = rest * (1.0 + allowed);
  const double square = (r + most * d).squaredNorm(), turn = r.dot(d), path = d.squaredNorm();
  // |r + t d|^2 = bound^2: path t^2 + 2 turn t + |r|^2 - bound^2 = 0.
  const auto root = [&](double bound, double sign) {
    const double off = r.squaredNorm() - bound * bound;
    const double t = (-turn + sign * std::sqrt(std::max(0.0, turn * turn - path * off))) / path;
    return std::isfinite(t) ? std::clamp(t, 0.0, most) : 0.0;
  };
  if (!(square <= longest * longest)) return root(longest, 1.0);
  const double shortest = rest * std::max(0.0, 1.0 - allowed);
  if (rod && !(square >= shortest * shortest)) return root(shortest, -1.0);
  return most;
}

LastResort::Bound LastResort::bound(const Field& inverse, double allowed, Field3& end) noexcept {
  const Grid& grid = pattern_.grid;
  const Misfit begins = misfitOf(follows_, inverse);
  if (begins.worst > kForced * allowed) {
    const Misfit ends = misfitOf(end, inverse);
    if (ends.squares < begins.squares || ends.worst < kForcedGrowth * begins.worst) return {};
  }
  const double most = std::max(allowed, begins.worst);
  double share = 1.0;
  // A shorter path may find a rod shorter than its end did, so repeat until nothing changes. It ends: each round moves
  // the share down to another of finitely many roots.
  for (double before = 2.0; share < before;) {
    before = share;
    forEachBound(inverse, [&](std::size_t n, std::size_t other, double rest, bool rod) {
      share = shareOf(other, n, rest, rod, most, share, end);
    });
  }
  if (share == 1.0) return {};
  Bound taken{share, 0.0};
  for (std::size_t n = 0; n < grid.size(); ++n) {
    const Vec3 from = follows_.at(n), path = end.at(n) - from;
    if (inverse[n] > 0.0) taken.moment += (1.0 - share) * pattern_.mass[n] * path.norm();
    end.set(n, share > 0.0 ? Vec3(from + share * path) : from);
  }
  return taken;
}

}  // namespace curtain
