// SPDX-License-Identifier: BSD-3-Clause
//
// Chooses the substeps of a frame: from the last tensions first (dt * omega_max), and as the safety net by halving a
// substep whose solve failed and growing again after good ones.
#pragma once

#include "curtain_sim/scene.h"
#include "solver/exact_solver.h"

namespace curtain {

class StepControl {
 public:
  StepControl(const SolverParams& params, const ClothPattern& pattern, const Vec3& gravity);

  void reset() noexcept;

  struct Plan {
    double h = 0.0;                      ///< [s], a whole share of what is left of the frame
    Scheme scheme = Scheme::kLeapfrog;
    bool must_accept = false;            ///< no smaller step is to be tried
  };
  /// remaining: what is left of the frame [s], > 0.
  Plan next(double remaining) const noexcept;
  void accepted(const Plan& plan, const SubstepOutcome& outcome) noexcept;
  void rejected(const Plan& plan) noexcept;

 private:
  double frame_;
  int fixed_substeps_;
  int max_substeps_;
  Method method_;
  double initial_omega_;  // of the cloth hanging by its own weight [1/s]
  double omega_;          // from the last tensions [1/s]
  double limit_;          // largest step that the rejections leave [s]
  double implicit_step_;  // of the implicit scheme as auto's fall-back [s]
  int good_ = 0;          // accepted substeps since the limit last changed
};

}  // namespace curtain
