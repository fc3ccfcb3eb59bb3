// SPDX-License-Identifier: BSD-3-Clause
//
// The account's books: the work of each force, substep by substep. What is left is the work of links and friction,
// which is never positive if they are right.
#include "cloth/archive.h"
#include "step/energy_account.h"

namespace curtain {

// All forces but damping, which only takes energy out.
void EnergyAccount::bookForces(const Field3& velocity, const NodeForces& forces, const Field3* with_elastic,
                               double kick) noexcept {
  double kinetic = 0.0, weight = 0.0, others = 0.0, elastic = 0.0;
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (pattern_.inverse_mass[n] <= 0.0 && pattern_.pinned[n] != kGuided) continue;
    const Vec3 mean = 0.5 * (before_.at(n) + velocity.at(n));
    kinetic += pattern_.mass[n] * mean.dot(velocity.at(n) - before_.at(n));
    const Vec3 own = pattern_.mass[n] * forces.gravity;
    weight += kick * own.dot(mean);
    others += kick * (forces.force->at(n) - own).dot(mean);
    if (with_elastic != nullptr) elastic += kick * (with_elastic->at(n) - forces.force->at(n)).dot(mean);
  }
  work_.kinetic += kinetic;
  work_.gravity += weight;
  work_.forces += others;
  work_.elastic += elastic;
}

void EnergyAccount::bookContacts(const Contacts& contacts, const Field3& velocity, double per_h) noexcept {
  for (const Contact& contact : contacts) {
    if (!contact.pushes()) continue;
    const Vec3 impulse = per_h * (contact.push * contact.normal + contact.slide);
    if (contact.obstacle != Contact::kCloth) work_.obstacles += impulse.dot(contact.surface_velocity);
    for (std::size_t k = 0; k < static_cast<std::size_t>(contact.nodes); ++k) {
      const std::size_t node = contact.node[k];
      if (pattern_.pinned[node] == kPinned) bookPin(contact.weight[k] * impulse, velocity.at(node));
    }
  }
}

void EnergyAccount::serialize(Archive& archive) {
  archive.number("held", held_);
  archive.optional("at_start", at_start_, 0.0, [&](double& energy) { archive.finite("energy", energy); });
  archive.finite("gravity", work_.gravity);
  archive.finite("elastic", work_.elastic);
  archive.finite("dissipated", work_.dissipated);
  archive.finite("forces", work_.forces);
  archive.finite("drive", work_.drive);
  archive.finite("pins", work_.pins);
  archive.finite("obstacles", work_.obstacles);
  archive.finite("kinetic", work_.kinetic);
}

}  // namespace curtain
