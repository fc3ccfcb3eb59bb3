// SPDX-License-Identifier: BSD-3-Clause
//
// Two-step backward differentiation formula (Gear 1971): links pull along their directions at the end of the step.
// Order 2, stable at any step, damps what it can't resolve. After an impact it forgets its history and is backward
// Euler for kStepsAfterImpact steps.
#pragma once

#include "solver/scheme.h"

namespace curtain {

class Bdf2 final : public Scheme {
 public:
  explicit Bdf2(const ClothPattern& pattern);

  /// The step before the last one.
  struct Memory {
    Field3 position, velocity;
    std::vector<double> place;  ///< of the carriers [m]
    double h = 0.0;             ///< length of the last step [s]; 0: no history
    int single_steps = 0;       ///< steps still to be made without history

    void forget() noexcept { h = 0.0, single_steps = 0; }
    void carry(Archive& archive);
  };
  Memory& memory() noexcept { return memory_; }
  const Memory& memory() const noexcept { return memory_; }

  double stepFor(double h) const noexcept override;
  SubstepStart start(const Task& task, const ClothState& state, SubstepOutcome& outcome) noexcept override;
  bool struck() noexcept override;
  void taken(const ClothState& before, double h) noexcept override;
  void passedOver() noexcept override;

 private:
  bool usesTwo(double h) const noexcept;

  const ClothPattern& pattern_;
  Memory memory_;
  ClothState base_;  // the formula's combination of the last two steps
};

}  // namespace curtain
