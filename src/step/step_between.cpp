// SPDX-License-Identifier: BSD-3-Clause
//
// Between substeps: velocities at the time of the positions, pulls, the account's books, and what is kept for trial
// runs.
#include <algorithm>
#include <cmath>

#include "cloth/free_body.h"
#include "step/constants.h"
#include "step/step.h"

namespace curtain {

void Step::currentVelocities(const ClothState& state, const NodeForces& forces, const Contacts* contacts,
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
  projectVelocity(state.position, age / inertia_.tensions().scale, out);
}

// Adds no energy but what the parts and surfaces drive. Keeps the momentum of cloth without pins.
void Step::projectVelocity(const Field3& position, double share, Field3& out) noexcept {
  const Contacts& touching = constraints_.contacts().all();
  const double most = account_.most(out, std::max(constraints_.distances().speed(), fastestSurface(touching)));
  const bool keeps = free_ && !pressesOnObstacle(contacts());
  const Momentum before = keeps ? momentumOf(pattern_, position, out) : Momentum();
  constraints_.project(position, share, account_, most, out);
  account_.bound(most, out);
  if (!keeps) return;
  const Momentum after = momentumOf(pattern_, position, out);
  const RigidMotion motion =
      rigidMotion(pattern_, position, {before.linear - after.linear, before.angular - after.angular});
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.mass[n] > 0.0) out.add(n, motion.at(position.at(n)));
  }
}

void Step::beginElastic() noexcept {
  if (elastic_ != nullptr) elastic_->begin(inertia_, inertia_.masses(), inertia_.tensions().scale, true);
}

const Field3* Step::elasticAt(const Field3& position, double& energy) noexcept {
  energy = 0.0;
  if (elastic_ == nullptr) return nullptr;
  beginElastic();
  return &elastic_->forceAt(position, energy);
}

void Step::copyPulls(const ClothState& state, const Contacts* contacts, Field3& out) noexcept {
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

void Step::book(const ClothState& state, const NodeForces& forces, const SubstepOutcome& outcome) noexcept {
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
  account_.bookDissipated(outcome.dissipated);
  account_.bookDrive(distances().work(account_.before(), state.velocity, per_h));
  if (guide() != nullptr) account_.bookDrive(guide()->work(account_.before(), state.velocity, outcome.kick));
}

void Step::save(Memory& memory) const {
  constraints_.save(memory.constraints);
  memory.tensions = inertia_.tensions();
  memory.held = account_.held();
  memory.left_off = left_off_;
  if (constraints_.guide() != nullptr) constraints_.guide()->save(memory.guide);
  memory.elastic.clear();
  if (elastic_ != nullptr) elastic_->save(memory.elastic);
}

void Step::restore(const Memory& memory) {
  constraints_.restore(memory.constraints);
  inertia_.tensions() = memory.tensions;
  account_.setHeld(memory.held);
  left_off_ = memory.left_off;
  if (constraints_.guide() != nullptr) constraints_.guide()->restore(memory.guide);
  if (elastic_ != nullptr) elastic_->restore(memory.elastic.data());
}

}  // namespace curtain
