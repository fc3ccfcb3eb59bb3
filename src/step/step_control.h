// SPDX-License-Identifier: BSD-3-Clause
//
// Chooses the substeps of a frame from the last tensions (h * omega_max). Rejected substeps are halved; the limit grows
// again after accepted ones.
#pragma once

#include <limits>

#include "curtain_sim/scene.h"
#include "step/step.h"
#include "step/trust_region.h"

namespace curtain {

class StepControl {
 public:
  StepControl(const SolverParams& params, const ClothPattern& pattern, const Vec3& gravity);

  void reset() noexcept;

  /// Share of the h * omega of cloth without ends beside it that steps are chosen for.
  static double phaseShare(const ClothPattern& pattern) noexcept;
  void setGravity(const ClothPattern& pattern, const Vec3& gravity) noexcept;
  /// Sets the length of the next frames [s]. To be called between two frames.
  void setFrameLength(double length) noexcept;

  /// The next substep; remaining: rest of the frame [s], > 0. h divides it into equal parts.
  SubstepPlan next(double remaining, const Step& solver) noexcept;
  /// Limits the substeps for the rest of the frame, >= 1; they may then be longer than the tensions ask for.
  void allow(int substeps) noexcept { allowed_ = substeps; }
  /// The last plan was longer because of allow().
  bool stretched() const noexcept { return stretched_; }
  /// Longest stable step by the last tensions (before the first: of the cloth hanging by its weight) [s].
  double longestStableStep() const noexcept;
  /// Asks for at least so many substeps a frame. True: the number has changed.
  bool askFor(int substeps) noexcept;
  /// Takes note of the tensions of a substep that another control planned.
  void watch(const SubstepOutcome& outcome) noexcept;
  /// The pins have changed: takes note of what the tensions of the last substep mean with these.
  void afterPinsChanged(const Step& solver) noexcept;
  void accepted(const SubstepPlan& plan, const SubstepOutcome& outcome) noexcept;
  void rejected(const SubstepPlan& plan, const SubstepOutcome& outcome) noexcept;
  /// The substep did not finish within a frame's computing time. Makes shorter ones, but not so short that the last
  /// resort takes over; if it was the scheme's retry, the last resort goes on.
  void tookTooLong(const SubstepPlan& plan) noexcept;

  void serialize(Archive& archive);

 private:
  double stretch(double wanted, double remaining, double bears) noexcept;
  double stepOfElastic(bool leapfrog, const Step& solver) const noexcept;
  double stepForTurn(double remaining) const noexcept;
  double stepFromTensions(bool frame_begins, const Step& solver) noexcept;

  double frame_;
  int fixed_substeps_;
  int max_substeps_;
  Method method_;
  double phase_share_;    // of the constants for h omega
  double initial_omega_;  // of the cloth hanging by its weight [1/s]
  double omega_;          // from the last tensions [1/s]
  double turning_;        // of the last substep [1/s]
  double last_step_;      // accepted [s]; infinite: none since reset()
  double scaled_step_;    // allowed by mass scaling, found when the frame began [s]; 0: not looked for
  double surface_step_;   // SubstepOutcome::longest_step [s]
  double limit_;          // longest step after rejections [s]
  int allowed_ = std::numeric_limits<int>::max();  // for the rest of the frame
  bool stretched_ = false;
  int asked_ = 1;      // substeps a frame, at least
  TrustRegion trust_;  // of the last resort
  bool composed_;      // substeps are made of stages (composition.h)
  bool shortens_;      // substeps as what is touched asks
  int good_ = 0;       // accepted substeps since the limit last changed
};

}  // namespace curtain
