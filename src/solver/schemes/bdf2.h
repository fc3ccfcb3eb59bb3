// SPDX-License-Identifier: BSD-3-Clause
//
// The backward differentiation formula of two steps (Gear 1971): forces act along the links' directions at the end of
// the step. Order 2, damps what it can't follow, stable at any step. After a blow it knows nothing of the steps before,
// and is backward Euler.
#pragma once

#include "solver/scheme.h"

namespace curtain {

class Bdf2 final : public Scheme {
 public:
  explicit Bdf2(const ClothPattern& pattern);

  /// The step before the present one, and what keeps it from being used.
  struct Memory {
    Field3 position, velocity;
    double h = 0.0;        ///< its length; 0: there is none [s]
    int single_steps = 0;  ///< to be made from one step before two are used again

    void forget() noexcept { h = 0.0, single_steps = 0; }
    void carry(Archive& archive);
  };
  Memory& memory() noexcept { return memory_; }
  const Memory& memory() const noexcept { return memory_; }

  double stepFor(double h) const noexcept override;
  SubstepStart start(const SubstepPlan& plan, double step, double kick, const NodeForces& forces,
                     const NodeInertia& inertia, const ClothState& state, SubstepOutcome& outcome) noexcept override;
  bool struck() noexcept override;
  void taken(const ClothState& before, double h) noexcept override;
  void passedOver() noexcept override;

 private:
  bool usesTwo(double h) const noexcept;

  const ClothPattern& pattern_;
  Memory memory_;
  ClothState base_;  // what the formula makes of the last two steps
};

}  // namespace curtain
