// SPDX-License-Identifier: BSD-3-Clause
//
// Work of each force on the cloth, substep by substep.
//
// A substep takes the velocities from v to v' by impulses; an impulse p at a node adds p . (v + v') / 2 to its kinetic
// energy, exactly. So a force's work is its impulse times the mean velocity. The rest is the work of links and
// friction, which is never positive if they are right. Leapfrog's velocities are half a substep apart from its
// positions: weight acts at the positions, so its work is the change of potential half way between them. A moving pin
// or obstacle puts in its reaction impulse times its own velocity.
#pragma once

#include "cloth/archive.h"
#include "cloth/cloth.h"
#include "contact/cloth_contact.h"
#include "curtain_sim/statistics.h"
#include "step/exact_solver.h"
#include "step/substep.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor.
class EnergyLedger {
 public:
  explicit EnergyLedger(const ClothPattern& pattern);

  /// Before a substep from this state.
  void begin(const ClothState& state) noexcept { before_ = state.velocity; }
  /// After it: h [s] long, under these forces, to this state. contacts: or null; links: null for schemes without
  /// ExactSolver.
  void end(const ClothState& state, const NodeForces& forces, const Contacts* contacts, const ExactSolver* links,
           double h, const SubstepOutcome& outcome) noexcept;

  void carry(Archive& archive);

  const Work& work() const noexcept { return work_; }
  /// For substeps that are repeated.
  void restore(const Work& work) noexcept { work_ = work; }

 private:
  void addForces(const Field3& velocity, const NodeForces& forces, const Field3* elastic, double kick) noexcept;
  void addPins(const Field3& velocity, const ExactSolver& links, double per_h) noexcept;

  const ClothPattern& pattern_;
  Field3 before_;
  Work work_;
};

}  // namespace curtain
