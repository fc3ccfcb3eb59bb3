// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/energy_ledger.h"

namespace curtain {

EnergyLedger::EnergyLedger(const ClothPattern& pattern) : pattern_(pattern) {
  before_.assign(pattern.grid.size(), 0.0);
}

// Weight, elastic forces, and all others but damping, which only takes energy out.
void EnergyLedger::addForces(const Field3& velocity, const NodeForces& forces, const Field3* elastic,
                             double kick) noexcept {
  double kinetic = 0.0, weight = 0.0, others = 0.0, stored = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.inverse_mass[n] <= 0.0 && pattern_.pinned[n] != kGuided) continue;
    const Vec3 mean = 0.5 * (before_.at(n) + velocity.at(n));
    kinetic += pattern_.mass[n] * mean.dot(velocity.at(n) - before_.at(n));
    const Vec3 own = pattern_.mass[n] * forces.gravity;
    weight += kick * own.dot(mean);
    others += kick * (forces.force->at(n) - own).dot(mean);
    if (elastic != nullptr) stored += kick * (elastic->at(n) - forces.force->at(n)).dot(mean);
  }
  work_.kinetic += kinetic;
  work_.gravity += weight;
  work_.forces += others;
  work_.bending += stored;
}

void EnergyLedger::addPins(const Field3& velocity, const ExactSolver& links, double per_h) noexcept {
  const Grid& grid = pattern_.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      if (pattern_.pinned[n] != kPinned) continue;
      const Vec3 v = velocity.at(n);
      if (!v.isZero(0.0)) work_.pins -= per_h * links.pullAt(i, j).dot(v);
    }
  }
  for (std::size_t n = grid.row(grid.rows); n < grid.size(); ++n) {  // those beside the cloth
    if (pattern_.pinned[n] == kPinned) work_.pins -= per_h * links.distances().pullAt(n).dot(velocity.at(n));
  }
}

void EnergyLedger::end(const ClothState& state, const NodeForces& forces, const Contacts* contacts,
                       const ExactSolver* links, double h, const SubstepOutcome& outcome) noexcept {
  addForces(state.velocity, forces, links != nullptr ? links->forcesWithElastic() : nullptr, outcome.kick);
  const double per_h = outcome.scale != 0.0 ? outcome.kick / outcome.scale : 1.0 / h;
  if (links != nullptr) addPins(state.velocity, *links, per_h);
  if (links != nullptr) work_.drive += links->distances().work(before_, state.velocity, per_h);
  if (links != nullptr && links->guide() != nullptr)
    work_.drive += links->guide()->work(before_, state.velocity, outcome.kick);
  for (std::size_t k = 0; contacts != nullptr && k < contacts->size(); ++k) {
    const Contact& contact = (*contacts)[k];
    if (contact.obstacle == Contact::kCloth || !contact.pushes()) continue;
    work_.obstacles += per_h * (contact.push * contact.normal + contact.slide).dot(contact.surface_velocity);
  }
}

}  // namespace curtain
