// SPDX-License-Identifier: BSD-3-Clause
//
// What tells one exact scheme from another: where a substep starts, how long forces act in it, along which directions
// its links pull, how much energy it may find, and what it leaves to the next one. The solve is the same for all. One
// file a scheme in schemes/.
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
    double age;      ///< velocities belong to positions so much of a step before, as a share of it
    bool remembers;  ///< steps before the last one: it must know of blows
  };

  explicit Scheme(const Rules& rules) noexcept : rules_(rules) {}
  virtual ~Scheme() = default;

  const Rules& rules() const noexcept { return rules_; }

  /// Length of the step from where a substep of h [s] starts.
  virtual double stepFor(double h) const noexcept { return h; }

  /// Where it starts. inertia: set for this substep. What of the momentum is not taken along is told in the outcome.
  virtual SubstepStart start(const SubstepPlan& plan, double step, double kick, const NodeForces& forces,
                             const NodeInertia& inertia, const ClothState& state, SubstepOutcome& outcome) noexcept {
    (void)plan, (void)outcome;
    return startFrom(state, step, kick, forces, inertia);
  }

  /// A string has snapped taut in the substep, or something has met something. True: it is to be made again.
  virtual bool struck() noexcept { return false; }
  /// The substep is taken, from here.
  virtual void taken(const ClothState& before, double h) noexcept { (void)before, (void)h; }
  /// One of another scheme is.
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
