// SPDX-License-Identifier: BSD-3-Clause
#include "step/node_inertia.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "step/constants.h"

namespace curtain {
namespace {

// Of the cloth: with heavy loads, a share of the whole would be all of its mass.
double freeMass(const ClothPattern& pattern, const Field& inverse_mass) {
  double sum = 0.0;
  for (std::size_t n = 0; n < pattern.grid.row(pattern.grid.rows); ++n) {
    if (inverse_mass[n] > 0.0) sum += pattern.mass[n];
  }
  return sum;
}

// Of the nodes that move by themselves.
void fill(const ClothPattern& pattern, bool guided_move, Field& inverse) {
  inverse = pattern.inverse_mass;
  for (std::size_t n = 0; n < inverse.size(); ++n) {
    if (pattern.pinned[n] == kHeld) inverse[n] = 0.0;
  }
  if (!guided_move) return;
  for (const std::size_t n : pattern.guided) inverse[n] = pattern.pinned[n] == kHeld ? 0.0 : 1.0 / pattern.mass[n];
}

}  // namespace

NodeInertia::NodeInertia(const ClothPattern& pattern)
    : pattern_(pattern),
      guided_move_(pattern.inverse_mass),
      guided_stand_(pattern.inverse_mass),
      masses_(&guided_move_),
      changed_(*masses_),
      keep_(pattern.grid.size(), 1.0),
      inverse_(masses_) {
  tensions_.load.assign(pattern.grid.size(), 0.0);
  pinsChanged();
}

void NodeInertia::pinsChanged() noexcept {
  fill(pattern_, true, guided_move_);
  fill(pattern_, false, guided_stand_);
  inverse_ = masses_;
  free_mass_ = freeMass(pattern_, *masses_);
}

double NodeInertia::heaviest() const noexcept {
  double worst = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) worst = std::max(worst, tensions_.load[n] * (*masses_)[n]);
  return worst;
}

void NodeInertia::setGuided(bool move) noexcept { inverse_ = masses_ = move ? &guided_move_ : &guided_stand_; }

void NodeInertia::forget() noexcept {
  std::fill(tensions_.load.begin(), tensions_.load.end(), 0.0);
  tensions_.heaviest = tensions_.scale = 0.0;
}

double NodeInertia::omegaSquared() const noexcept {
  return 2.0 * tensions_.heaviest / std::abs(tensions_.scale) + elastic_;
}

double NodeInertia::elasticShare(double scale, bool explicit_links) const noexcept {
  const double asked = std::abs(scale) * elastic_,
               most = explicit_links ? kStablePhase * kStablePhase : kElasticBackward;
  if (!(asked > most)) return 1.0;
  return (explicit_links ? most - kMinForTensions : most) / asked;
}

void NodeInertia::set(const NodeForces& forces, double kick, double scale, double max_phase, bool implicit) noexcept {
  inverse_ = masses_;
  damped_ = forces.has_damping;
  const std::size_t size = pattern_.grid.size();
  if (damped_) {
    inverse_ = &changed_;
    for (std::size_t n = 0; n < size; ++n) {
      const double w = (*masses_)[n];
      const DampedStep step =
          implicit ? implicitlyDampedStep(forces.damping[n], w, kick) : dampedStep(forces.damping[n], w, kick);
      changed_[n] = step.gain * w;
      keep_[n] = step.keep;
    }
  }
  if (max_phase <= 0.0 || tensions_.scale == 0.0) return;
  const double borne = std::abs(scale) * elastic_ * elasticShare(scale, true);
  const double left = std::max(kMinForTensions, max_phase * max_phase - borne);
  const double per_load = 2.0 * std::abs(scale / tensions_.scale) / left;
  if (!(per_load * tensions_.heaviest > 1.0)) return;
  // Not more than all of the cloth: where links can't keep their lengths their tensions are as large as the inertia
  // that they move, and inertia after them would grow without bound.
  const double* const w = inverse_->data();
  for (std::size_t n = 0; n < size; ++n) {
    const double needed = std::min(per_load * tensions_.load[n], free_mass_);
    changed_[n] = needed * w[n] > 1.0 ? 1.0 / needed : w[n];
  }
  inverse_ = &changed_;
}

// Mass that scaling adds when each node must weigh so much per load [kg].
double NodeInertia::addedMass(double per_load) const noexcept {
  double sum = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    const double extra = per_load * tensions_.load[n] - pattern_.mass[n];
    sum += (*masses_)[n] > 0.0 && extra > 0.0 ? extra : 0.0;
  }
  return sum;
}

double NodeInertia::stepForPhase(double max_phase, double scaling_share) const noexcept {
  constexpr double kLargest = 1e4;  // bound of the search, over the step without mass scaling
  if (tensions_.scale == 0.0 || !(tensions_.heaviest > 0.0)) return std::numeric_limits<double>::infinity();
  double per_load = 1.0 / tensions_.heaviest;  // no node is scaled; proportional to h^2
  const double allowed = scaling_share * free_mass_;
  double factor = 2.0;
  for (int root = 0; root < 6 && scaling_share > 0.0; ++root) {  // to within 2^(1/32)
    while (per_load * tensions_.heaviest < kLargest && addedMass(per_load * factor) <= allowed) {
      per_load *= factor;
      if (root > 0) break;
    }
    factor = std::sqrt(factor);
  }
  const double per_omega = 0.5 * std::abs(tensions_.scale) * per_load;  // of the tensions, [s^2]
  return max_phase * std::sqrt(per_omega / (1.0 + elastic_ * per_omega));
}

}  // namespace curtain
