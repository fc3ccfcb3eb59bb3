// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/force_field.h"

namespace curtain {

ForceField::ForceField(const Scene& scene, const ClothPattern& pattern, const PartList& parts)
    : scene_(scene), pattern_(pattern), parts_(parts), sum_(forces_.damping) {
  const std::size_t size = pattern.grid.size();
  weight_.assign(size, 0.0);
  gravityChanged();
  sum_.led.reserve(size);
  sum_.air.assign(size, 0.0);
  forces_.damping.assign(size, 0.0);
  reset();
}

void ForceField::reset() noexcept {
  sum_.force.assign(pattern_.grid.size(), 0.0);
  forces_.force = &sum_.force;
}

void ForceField::gravityChanged() noexcept {
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) weight_.set(n, pattern_.mass[n] * scene_.gravity);
}

bool ForceField::begin(const ClothState& state, double time, double done, double h) noexcept {
  sum_.time = time;
  sum_.done = done;
  sum_.h = h;
  sum_.acts = sum_.damps = sum_.reads_air = false;
  sum_.led.clear();
  for (Part* const part : parts_) part->announce(state, sum_);
  return sum_.reads_air;
}

// With weight alone the solver takes a shorter path.
const NodeForces& ForceField::evaluate(const ClothState& state, const SubstepAhead& ahead) noexcept {
  forces_.weight_only = !sum_.acts;
  forces_.force = sum_.acts ? &sum_.force : &weight_;
  forces_.gravity = scene_.gravity;
  forces_.has_damping = sum_.damps;
  if (!sum_.acts && !sum_.damps) return forces_;
  sum_.ahead = ahead;
  if (sum_.acts) sum_.force = weight_;
  if (sum_.damps) sum_.damping.assign(sum_.damping.size(), 0.0);
  for (Part* const part : parts_) part->addForces(state, sum_);
  return forces_;
}

}  // namespace curtain
