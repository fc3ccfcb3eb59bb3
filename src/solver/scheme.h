// SPDX-License-Identifier: BSD-3-Clause
//
// What distinguishes the exact schemes: where a substep starts, how long forces act in it, along which directions links
// pull, and what it leaves to the next one. The solve is the same for all. One file a scheme in schemes/.
#pragma once

#include "solver/node_inertia.h"
#include "solver/substep.h"
#include "solver/warp_solver.h"

namespace curtain {

class Scheme {
 public:
  struct Rules {
    bool follows;    ///< links pull along their directions at the end of the step, not at its start
    bool backward;   ///< damping acts on the velocities at the end
    double age;      ///< velocities lag behind the positions by this share of a step
    bool remembers;  ///< uses steps before the last one, so it must be told of impacts
  };

  explicit Scheme(const Rules& rules) noexcept : rules_(rules) {}
  virtual ~Scheme() = default;

  const Rules& rules() const noexcept { return rules_; }

  /// Length of the step from start() when the substep is h long [s].
  virtual double stepFor(double h) const noexcept { return h; }

  /// Start of the substep. inertia: set for it. Momentum that is not taken along is added to the outcome.
  virtual SubstepStart start(const SubstepPlan& plan, double step, double kick, const NodeForces& forces,
                             const NodeInertia& inertia, const ClothState& state, SubstepOutcome& outcome) noexcept {
    (void)plan, (void)outcome;
    return startFrom(state, step, kick, forces, inertia);
  }

  /// A string has snapped taut in the substep, or a new contact pushes. True: make the substep again.
  virtual bool struck() noexcept { return false; }
  /// The substep was accepted; before: the state at its start.
  virtual void taken(const ClothState& before, double h) noexcept { (void)before, (void)h; }
  /// A substep of another scheme was accepted.
  virtual void passedOver() noexcept {}

 protected:
  static SubstepStart startFrom(const ClothState& base, double step, double kick, const NodeForces& forces,
                                const NodeInertia& inertia) noexcept {
    const bool falls = forces.weight_only && inertia.massesAlone();
    return {base, *forces.force, falls ? &forces.gravity : nullptr, inertia.keep(), kick, step};
  }

 private:
  const Rules rules_;
};

}  // namespace curtain
