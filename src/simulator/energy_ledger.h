// SPDX-License-Identifier: BSD-3-Clause
//
// Where the cloth's energy comes from and goes to, substep by substep.
//
// A substep takes the velocities from v to v' by impulses; an impulse p at a node adds p . (v + v') / 2 to its kinetic
// energy, exactly. So each force's work is its impulse times the mean of both velocities, and what is left over is the
// work of the links and of what cloth rubs on: where they are as they should be that is never more than nothing.
// Leapfrog's velocities lie half a substep apart from its positions; weight acts at the positions, so its work is what
// the potential changes by half way between them. Links and contacts give their impulses to what they are fixed to: a
// pin or obstacle that moves puts in theirs times its own velocity.
#pragma once

#include "cloth/archive.h"
#include "cloth/cloth.h"
#include "contact/cloth_contact.h"
#include "curtain_sim/statistics.h"
#include "solver/exact_solver.h"
#include "solver/substep.h"

namespace curtain {

/// Not thread-safe. Allocates nothing after construction.
class EnergyLedger {
 public:
  explicit EnergyLedger(const ClothPattern& pattern);

  /// A substep is about to be made from this state.
  void begin(const ClothState& state) noexcept { before_ = state.velocity; }
  /// It was: h [s] long, under these forces, to this state. contacts: or null; links: or null where the solver keeps
  /// none.
  void end(const ClothState& state, const NodeForces& forces, const Contacts* contacts, const ExactSolver* links,
           double h, const SubstepOutcome& outcome) noexcept;

  void carry(Archive& archive);

  const Work& work() const noexcept { return work_; }
  /// To be put back when substeps are made again.
  void restore(const Work& work) noexcept { work_ = work; }

 private:
  void addForces(const Field3& velocity, const NodeForces& forces, double kick) noexcept;
  void addPins(const Field3& velocity, const ExactSolver& links, double per_h) noexcept;

  const ClothPattern& pattern_;
  Field3 before_;
  Work work_;
};

}  // namespace curtain
