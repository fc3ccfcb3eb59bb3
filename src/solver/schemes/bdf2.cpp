// SPDX-License-Identifier: BSD-3-Clause
#include "solver/schemes/bdf2.h"

#include <algorithm>

#include "solver/constants.h"

namespace curtain {

Bdf2::Bdf2(const ClothPattern& pattern) : Scheme({true, true, 0.0, true}), pattern_(pattern) {
  for (Field3* field : {&memory_.position, &memory_.velocity, &base_.position, &base_.velocity})
    field->assign(pattern.grid.size(), 0.0);
  for (std::vector<double>* places : {&memory_.place, &base_.place}) places->assign(pattern.rail.size(), 0.0);
}

bool Bdf2::usesTwo(double h) const noexcept { return memory_.h != 0.0 && h <= kMostGrowth * memory_.h; }

// Variable steps (Hairer, Norsett, Wanner 1993, Sect. III.5), ratio r = h / h_before:
//   y' = (1+r)^2/(1+2r) y - r^2/(1+2r) y_before + (1+r)/(1+2r) h f.
double Bdf2::stepFor(double h) const noexcept {
  if (!usesTwo(h)) return h;
  const double r = h / memory_.h;
  return (1.0 + r) / (1.0 + 2.0 * r) * h;
}

SubstepStart Bdf2::start(const Task& task, const ClothState& state, SubstepOutcome&) noexcept {
  const double h = task.plan.h;
  if (!usesTwo(h)) return startFrom(state, task);
  const double r = h / memory_.h;
  const double change = r * r / (1.0 + 2.0 * r);  // (1+r)^2/(1+2r) = 1 + change: cloth at rest stays to the bit
  const auto combine = [change](const Field& y, const Field& older, Field& out) {
    for (std::size_t n = 0; n < y.size(); ++n) out[n] = y[n] + change * (y[n] - older[n]);
  };
  combine(state.position.x, memory_.position.x, base_.position.x);
  combine(state.position.y, memory_.position.y, base_.position.y);
  combine(state.position.z, memory_.position.z, base_.position.z);
  combine(state.velocity.x, memory_.velocity.x, base_.velocity.x);
  combine(state.velocity.y, memory_.velocity.y, base_.velocity.y);
  combine(state.velocity.z, memory_.velocity.z, base_.velocity.z);
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (task.inertia.masses()[n] > 0.0) continue;  // pins have no history: their motion is prescribed
    base_.position.set(n, state.position.at(n) + (h - task.step) * state.velocity.at(n));
    base_.velocity.set(n, state.velocity.at(n));
  }
  // Carriers: the same combinations of their places and of their speeds along the rail.
  const RailPattern& rail = pattern_.rail;
  for (std::size_t k = 0; k < rail.size(); ++k) {
    const auto n = static_cast<std::size_t>(rail.columns[k]);
    const double speed = state.velocity.at(n).dot(rail.path.at(state.place[k]).tangent);
    const double older = memory_.velocity.at(n).dot(rail.path.at(memory_.place[k]).tangent);
    base_.place[k] = state.place[k] + change * (state.place[k] - memory_.place[k]);
    const RailPath::Place at = rail.path.at(base_.place[k]);
    base_.position.set(n, at.point);
    base_.velocity.set(n, (speed + change * (speed - older)) * at.tangent);
  }
  return startFrom(base_, task);
}

bool Bdf2::struck() noexcept {
  memory_.single_steps = kStepsAfterImpact;
  const bool used_two = memory_.h != 0.0;
  memory_.h = 0.0;
  return used_two;
}

void Bdf2::taken(const ClothState& before, double h) noexcept {
  passedOver();
  if (memory_.single_steps > 0) return;
  memory_.position = before.position;
  memory_.velocity = before.velocity;
  memory_.place = before.place;
  memory_.h = h;
}

void Bdf2::passedOver() noexcept {
  memory_.single_steps = std::max(0, memory_.single_steps - 1);
  memory_.h = 0.0;
}

}  // namespace curtain
