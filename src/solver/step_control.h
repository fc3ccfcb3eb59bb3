// SPDX-License-Identifier: BSD-3-Clause
//
// Chooses the substeps of a frame: from the last tensions first (h * omega_max), and as the safety net by halving a
// substep whose solve failed and growing again after good ones.
#pragma once

#include <limits>

#include "curtain_sim/scene.h"
#include "solver/exact_solver.h"
#include "solver/trust_region.h"

namespace curtain {

class StepControl {
 public:
  StepControl(const SolverParams& params, const ClothPattern& pattern, const Vec3& gravity);

  void reset() noexcept;
  void takeGravity(const ClothPattern& pattern, const Vec3& gravity) noexcept;
  /// Frames are so long from now on [s]. To be called between two frames.
  void takeFrame(double length) noexcept;

  /// The next substep; remaining: what is left of the frame [s], > 0; its whole length when a frame begins. h is a
  /// whole share of it.
  SubstepPlan next(double remaining, const ExactSolver& solver) noexcept;
  /// Substeps that the rest of the frame may be made in, >= 1: beyond that they are longer than the tensions ask for.
  void allow(int substeps) noexcept { allowed_ = substeps; }
  /// The last plan was longer for that.
  bool stretched() const noexcept { return stretched_; }
  /// From the last tensions (before the first: of the cloth hanging by its own weight) [s].
  double longestStableStep() const noexcept;
  /// h * omega from which nodes are heavier rather than the step unstable.
  static double stablePhase() noexcept;
  /// At least so many substeps a frame. True when that is not what was asked for before.
  bool askFor(int substeps) noexcept;
  /// Takes note of the tensions of a substep that was not its own.
  void watch(const SubstepOutcome& outcome) noexcept;
  /// Other columns move now, with the tensions that the solver has for them.
  void wake(const ExactSolver& solver) noexcept;
  void accepted(const SubstepPlan& plan, const SubstepOutcome& outcome) noexcept;
  void rejected(const SubstepPlan& plan) noexcept;
  /// It was not done within a frame's computing time. Shorter ones are, but not the fall-back, which has no shorter
  /// ones.
  void tookTooLong(const SubstepPlan& plan) noexcept;

  void carry(Archive& archive);

 private:
  double stretch(double wanted, double remaining) noexcept;
  double stepFromTensions(bool frame_begins, const ExactSolver& solver) noexcept;

  double frame_;
  int fixed_substeps_;
  int max_substeps_;
  Method method_;
  double initial_omega_;  // of the cloth hanging by its own weight [1/s]
  double omega_;          // from the last tensions [1/s]
  double turning_;        // of the last substep [1/s]
  double heavier_step_;  // what the phase allows where few nodes may be heavier, found when the frame began [s]; 0: not
                         // asked
  double surface_step_;  // in which what pushes goes a share of a link [s]
  double limit_;         // largest step that the rejections leave [s]
  int allowed_ = std::numeric_limits<int>::max();  // for the rest of the frame
  bool stretched_ = false;
  int asked_ = 1;      // substeps a frame
  TrustRegion trust_;  // of the last resort
  bool composed_;      // substeps are made of stages (composition.h)
  int good_ = 0;       // accepted substeps since the limit last changed
};

}  // namespace curtain
