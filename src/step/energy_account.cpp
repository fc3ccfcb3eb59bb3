// SPDX-License-Identifier: BSD-3-Clause
#include "step/energy_account.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "cloth/wide.h"
#include "step/constants.h"

namespace curtain {
namespace {

// Largest energy, from put_in (without links) and driven (all mass at the speed of the fastest pin), both twice an
// energy [J]. The root is of a ratio, so that other units give the same bits.
double maxOf(double put_in, double driven) noexcept {
  if (!(put_in > 0.0)) return 4.0 * driven;
  const double factor = 1.0 + 2.0 * std::sqrt(driven / put_in);
  return factor * factor * put_in;
}

}  // namespace

EnergyAccount::EnergyAccount(const ClothPattern& pattern, const NodeInertia& inertia, double stretch_tolerance,
                             double links)
    : pattern_(pattern), inertia_(inertia), stretch_tolerance_(stretch_tolerance), links_(links) {
  for (std::vector<std::size_t>* const nodes : {&pins_, &held_nodes_}) nodes->reserve(pattern.grid.size());
  before_.assign(pattern.grid.size(), 0.0);
  pinsChanged();
}

void EnergyAccount::pinsChanged() noexcept {
  pins_.clear();
  held_nodes_.clear();
  free_mass_ = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.pinned[n] == kPinned) pins_.push_back(n);
    if (inertia_.masses()[n] > 0.0)
      free_mass_ += pattern_.mass[n];
    else if (pattern_.isThere(n))
      held_nodes_.push_back(n);
  }
}

// A rod that is predicted longer by a share e, from rest, has turned by sqrt(2 e) and gains e / 2 of its energy.
bool EnergyAccount::isSmall(double predicted_violation) noexcept {
  return predicted_violation <= 2.0 * (kMaxAdded - 1.0);
}

// Pins and obstacles that move may absorb what links seem to absorb, so nothing more is held then.
EnergyAccount::Entry EnergyAccount::entryOf(const Scheme::Rules& rules, const SubstepStart& start, const Field3& end,
                                            const Drive& drive, double can_hold) const noexcept {
  const Vec3 frame = frameOf(start.state.velocity);
  Sums sums = sumsOf(start, end, frame, rules.follows);
  sums.put_in += drive.put_in;
  const double driven = drivenBy(start.state.velocity, frame, drive.pushed);
  const bool moved = fastest(start.state.velocity, frame, drive.moving) > 0.0;
  const double held = std::min(held_, can_hold), taken = moved ? 0.0 : sums.put_in - sums.stepped;
  Entry entry;
  entry.held = std::clamp(held + taken, 0.0, can_hold);
  if (!(sums.stepped > maxOf(kMaxAdded * sums.put_in, driven))) return entry;
  const double most = maxOf(sums.put_in, driven) + held;
  if (!(sums.stepped > most)) return entry;
  entry.most = most;
  entry.made = sums.stepped - most;
  return entry;
}

double EnergyAccount::most(const Scheme::Rules& rules, const SubstepStart& start, const Field3& end,
                           const Drive& drive) const noexcept {
  const Vec3 frame = frameOf(start.state.velocity);
  return maxOf(sumsOf(start, end, frame, rules.follows).put_in + drive.put_in,
               drivenBy(start.state.velocity, frame, drive.pushed));
}

double EnergyAccount::most(const Field3& velocity, double surface) const noexcept {
  const Vec3 frame = frameOf(velocity);
  return maxOf(kineticOf(velocity, frame), drivenBy(velocity, frame, surface));
}

void EnergyAccount::bound(double most, Field3& velocity) const noexcept {
  const Vec3 frame = frameOf(velocity);
  const double seen = kineticOf(velocity, frame);
  if (!(seen > most)) return;
  const double all = frame.isZero(0.0) ? seen : kineticOf(velocity, Vec3::Zero());
  if (!(all > 0.0)) return;
  // Equal frames are a case of their own: with unsolvable links the energies overflow and their difference is lost.
  const double left = frame.isZero(0.0) ? most : all - (seen - most);
  const double share = std::sqrt(std::max(0.0, left) / all);
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (inertia_.masses()[n] > 0.0) velocity.set(n, share * velocity.at(n));  // pins keep their prescribed velocity
  }
}

// Summed by lanes: the order does not depend on the register width.
CURTAIN_WIDE EnergyAccount::Sums EnergyAccount::sumsOf(const SubstepStart& start, const Field3& end, const Vec3& frame,
                                                       bool backward) const noexcept {
  const std::size_t size = pattern_.grid.size();
  const Field3 &from = start.state.position, &velocity = start.state.velocity;
  const double* const mass = pattern_.mass.data();
  const double* const free = inertia_.masses().data();
  // keep is read unconditionally: masked loads from a null pointer are a hundred times slower.
  const bool damped = start.keep != nullptr;
  const double* const keep = damped ? start.keep->data() : mass;
  const double per_step = 1.0 / start.h, kick = start.kick;
  std::array<double, kLane> stepped{}, put_in{};
  const auto add = [&](const Field& x_next, const Field& x_from, const Field& v_field, const Field& f_field, double u) {
    const double *const x = x_next.data(), *const a = x_from.data(), *const v = v_field.data(),
                        *const f = f_field.data();
    for (std::size_t n = 0; n < size; n += kLane) {
#pragma omp simd
      for (std::size_t l = 0; l < kLane; ++l) {
        const double whole = mass[n + l];
        const double m = free[n + l] > 0.0 ? whole : 0.0, time = free[n + l] > 0.0 ? kick : 0.0;
        const double made = per_step * (x[n + l] - a[n + l]) - u;
        const double kept = keep[n + l];
        const double before = (damped ? kept : 1.0) * v[n + l] - u;
        stepped[l] += m * made * made;
        const double gains = time * f[n + l], without = before + free[n + l] * gains;
        put_in[l] += m * before * before + gains * (before + (backward ? without : made));
      }
    }
  };
  add(end.x, from.x, velocity.x, start.force.x, frame.x());
  add(end.y, from.y, velocity.y, start.force.y, frame.y());
  add(end.z, from.z, velocity.z, start.force.z, frame.z());
  Sums sums;
  for (std::size_t l = 0; l < kLane; ++l) {
    sums.stepped += stepped[l];
    sums.put_in += put_in[l];
  }
  return sums;
}

double EnergyAccount::kineticOf(const Field3& velocity, const Vec3& frame) const noexcept {
  double sum = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (inertia_.masses()[n] > 0.0) sum += pattern_.mass[n] * (velocity.at(n) - frame).squaredNorm();
  }
  return sum;
}

Vec3 EnergyAccount::frameOf(const Field3& velocity) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (const std::size_t pin : pins_) sum += velocity.at(pin);
  return pins_.empty() ? sum : sum / static_cast<double>(pins_.size());
}

// Square of the largest speed of a pin, or of what is touched.
double EnergyAccount::fastest(const Field3& velocity, const Vec3& frame, double surface) const noexcept {
  const double passes = surface > 0.0 ? surface + frame.norm() : 0.0;
  double square = passes * passes;
  for (const std::size_t n : held_nodes_) square = std::max(square, (velocity.at(n) - frame).squaredNorm());
  return square;
}

double EnergyAccount::excess(double energy) noexcept {
  if (!at_start_) at_start_ = energy;
  return energy - *at_start_;
}

void EnergyAccount::removeExcess(const Energy& now, Field3& velocity) const noexcept {
  const double share = std::sqrt(std::max(0.0, (*at_start_ - now.potential) / now.kinetic));
  if (!std::isfinite(share)) return;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.pinned[n] != kPinned) velocity.set(n, share * velocity.at(n));
  }
}

double EnergyAccount::fromTolerance(double h) const noexcept {
  const double speed = 2.0 * stretch_tolerance_ * links_ / h;
  return free_mass_ * speed * speed;
}

}  // namespace curtain
