// SPDX-License-Identifier: BSD-3-Clause
//
// The scheme of Cheng 2000, Sect. 3, as printed: per column, from the lowest node up, each node as a pendulum on the
// node above it, Eqs. (5)-(8), one pass, explicit; then, along the rows, two neighbours that are too far apart are moved
// together. No equation is solved, nothing is iterated. Kept to be read and measured against; the rods drift off their
// lengths because Eq. (5) takes the node above for a fixed point.
#pragma once

#include "solver/substep.h"

namespace curtain {

class PaperSolver {
 public:
  explicit PaperSolver(const ClothPattern& pattern);

  /// One substep of length h > 0 [s]; finder may be null. Not accepted where it has blown up: positions are as they were then.
  SubstepOutcome substep(const NodeForces& forces, double h, ContactFinder* finder, ClothState& state,
                         StageClock& clock) noexcept;

 private:
  void touch(ContactFinder* finder, double h, ClothState& state) noexcept;
  void moveColumn(int column, const NodeForces& forces, double h, ClothState& state) const noexcept;
  void adjustRow(int row, ClothState& state) const noexcept;

  bool sound(const ClothState& state, double h) const noexcept;

  const ClothPattern& pattern_;
  double most_way_;  // of a node in a substep [m]
  Field3 start_;
};

}  // namespace curtain
