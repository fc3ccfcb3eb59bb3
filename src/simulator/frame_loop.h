// SPDX-License-Identifier: BSD-3-Clause
//
// The substeps of a frame, the loop of Cheng 2000, Sect. 1.3: each is planned, attempted, and accepted or repeated with
// a smaller step.
#pragma once

#include "simulator/budget.h"
#include "simulator/motion.h"
#include "simulator/step_controls.h"

namespace curtain {

/// Steps that a frame was made of.
struct StepTally {
  int steps = 0;          ///< leapfrog steps
  bool of_stages = true;  ///< all of them were stages of whole substeps
};

class FrameLoop {
 public:
  /// All arguments must outlive this.
  FrameLoop(Motion& motion, StepControls& controls, Budget& budget);

  /// Makes a frame. Returns the share of it that was made: less than 1 when the computing time was over.
  double make();
  /// Of that frame.
  const StepTally& tally() const noexcept { return tally_; }
  /// A pin stayed where it was in a substep of that frame.
  bool pinsWaited() const noexcept { return pins_waited_; }

  /// Makes a substep of five stages. False, and nothing changed: stages are paused, or a string pulls, something
  /// touches, or there is a part that can't be reversed in time.
  bool makeStages(const SubstepPlan& plan, double done);

 private:
  double makeSubstep(double done);
  SubstepPlan plan(StepControl& steps, double done);
  SubstepOutcome attemptInTime(const SubstepPlan& plan, double done);
  void reject(StepControl& steps, const SubstepPlan& plan, const SubstepOutcome& outcome) noexcept;
  void accept(StepControl& steps, const SubstepPlan& plan, const SubstepOutcome& outcome) noexcept;
  void lowerQuality(FrameQuality quality) noexcept;
  void countSubstep(int steps) noexcept;

  Motion& motion_;
  StepControls& controls_;
  Budget& budget_;
  Motion::Checkpoint before_;  // start of a substep of stages
  StepTally tally_;
  bool pins_waited_ = false;
};

}  // namespace curtain
