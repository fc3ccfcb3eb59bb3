// SPDX-License-Identifier: BSD-3-Clause
//
// All contact of a cloth: what may touch within a substep, and whether anything went through anything after all.
#pragma once

#include "contact/node_contacts.h"
#include "contact/obstacle_set.h"
#include "solver/substep.h"

namespace curtain {

class ClothContact : public ContactFinder {
 public:
  /// pattern and obstacles must outlive this.
  ClothContact(const ClothPattern& pattern, const ContactParams& params, const ObstacleSet& obstacles);

  Contacts* begin(const ClothPattern& pattern, const Field3& start, const Field3& predicted, double h) noexcept override;
  Verdict verify(const Field3& start, const Field3& end) noexcept override;
  void hold(const Field3& start, Field3& end) noexcept override;

  /// After every accepted substep, whether all links could be brought to their lengths; inverse_inertia: how its nodes
  /// answered [1/kg], scale: its h * kick [s^2].
  void afterSubstep(bool settled, const Field& inverse_inertia, double scale) noexcept;

  /// Contacts that find room without an allocation.
  std::size_t capacity() const noexcept { return contacts_.capacity(); }
  /// Something of the last substep may touch.
  bool any() const { return !contacts_.empty(); }
  const Contacts& contacts() const { return contacts_; }
  /// Nodes pressed on in the last substep.
  int contactCount() const noexcept;
  /// How deep the deepest node is inside an obstacle [m]; 0: none is.
  double deepestPenetration(const Field3& position) const noexcept { return nodes_.deepest(contacts_, position); }
  /// Adds the contact forces of the last substep [N].
  void addForces(Field3& force) const noexcept;
  void forget() noexcept;

 private:
  void recall() noexcept;

  const ClothPattern& pattern_;
  const ObstacleSet& obstacles_;
  NodeContacts nodes_;
  double thickness_;
  Contacts contacts_, last_;  // of this substep; of the last accepted one, those that pushed
  double last_scale_ = 0.0;   // of its multipliers [s^2]
  int slippery_ = 0;          // substeps still to go without friction
};

}  // namespace curtain
