// SPDX-License-Identifier: BSD-3-Clause
//
// Contact of the cloth with obstacles: every node that may touch within the substep is held to a plane, tangent to the
// obstacle and a thickness away, with Coulomb friction against the moving surface. Inelastic.
#pragma once

#include "contact/obstacle_set.h"
#include "solver/contacts.h"

namespace curtain {

class ObstacleContacts {
 public:
  /// thickness: kept between cloth and obstacle [m]; pattern and obstacles must outlive this.
  ObstacleContacts(const ClothPattern& pattern, double thickness, const ObstacleSet& obstacles)
      : pattern_(pattern), thickness_(thickness), obstacles_(obstacles) {}

  /// Some obstacle may be touched in a substep whose nodes go from start to about predicted. False: none can, whatever the
  /// links do.
  bool mayTouch(const Field3& start, const Field3& predicted) noexcept;

  /// Adds what may touch on the way from start to predicted, in a substep of h [s], with the multipliers of the last accepted
  /// substep. slippery: without friction.
  void collect(const Field3& start, const Field3& predicted, double h, bool slippery, Contacts& contacts) noexcept;

  /// Adds contacts for parts of the cloth that would go through an obstacle on the way from start to end; returns how many.
  int verify(const Field3& start, const Field3& end, double h, Contacts& contacts) noexcept;

  /// Takes over the multipliers of an accepted substep.
  void remember(const Contacts& contacts) noexcept;
  void forget() noexcept { last_.clear(); }

  /// How deep the deepest node is inside an obstacle [m]; 0: none is.
  double deepest(const Contacts& contacts, const Field3& position) const noexcept;

 private:
  void collectNodes(int obstacle, const Field3& start, const Field3& predicted, double h, bool slippery, Contacts& contacts) const;

  const ClothPattern& pattern_;
  double thickness_;
  const ObstacleSet& obstacles_;
  Contacts last_;  // that pushed
};

}  // namespace curtain
