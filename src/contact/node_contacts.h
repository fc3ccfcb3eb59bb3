// SPDX-License-Identifier: BSD-3-Clause
//
// Contact of first-layer nodes with obstacles: every node that may touch within the substep is held to a plane, tangent to
// the obstacle and a thickness away, with Coulomb friction against the moving surface. Inelastic.
#pragma once

#include "contact/obstacle_set.h"
#include "solver/contacts.h"

namespace curtain {

class NodeContacts {
 public:
  /// pattern and obstacles must outlive this.
  NodeContacts(const ClothPattern& pattern, double thickness, const ObstacleSet& obstacles)
      : pattern_(pattern), thickness_(thickness), obstacles_(obstacles) {}

  /// Adds the contacts of nodes that may touch an obstacle on the way from start to predicted, within a substep of h [s].
  /// slippery: without friction.
  void collect(int obstacle, const Field3& start, const Field3& predicted, double h, bool slippery, Contacts& contacts) const;

  /// How deep the deepest node is inside an obstacle [m]; 0: none is.
  double deepest(const Contacts& contacts, const Field3& position) const noexcept;

 private:
  const ClothPattern& pattern_;
  double thickness_;
  const ObstacleSet& obstacles_;
};

}  // namespace curtain
