// SPDX-License-Identifier: BSD-3-Clause
//
// solver.position_tolerance: chooses the substeps of a frame so that the error of the motion stays below it
// (ErrorEstimate). Pilot runs before the motion give a first guess; a reference run beside it, with other substeps,
// measures the error.
#pragma once

#include "simulator/accuracy/error_estimate.h"
#include "simulator/frame_loop.h"

namespace curtain {

class ErrorControl {
 public:
  /// A tolerance is asked for, and the method's error can be estimated.
  static bool wanted(const SolverParams& params) {
    return params.position_tolerance > 0.0 && ErrorEstimate::knows(params.method);
  }

  /// All arguments must outlive this.
  ErrorControl(Motion& motion, StepControls& controls, FrameLoop& loop, Budget& budget);

  /// Before the motion: some frames of it, twice, to find the substeps that it needs.
  void makePilotRuns();
  /// Before a frame: advances the reference run where one is due, and asks for substeps.
  void beginFrame();
  /// After a frame. share: of it that was made.
  void endFrame(double share);
  /// Restarts the reference run from the motion.
  void lose() noexcept { reference_.lost = true; }

  void reset() noexcept { estimate_.reset(); }
  /// The frames' length has changed.
  void frameLengthChanged() noexcept {
    estimate_.setFrameLength(motion_.times.length());
    lose();
  }
  /// What has been learnt of the error, to be gone on with.
  ErrorEstimate& estimate() noexcept { return estimate_; }
  void serialize(Archive& archive);

 private:
  struct Reference {
    Motion::Checkpoint at;
    int substeps = 0;   // a frame
    StepTally tally;    // of the last frame
    bool lost = false;  // a substep failed
    bool in_finer_steps = false;

    void serialize(Archive& archive);
  };
  bool makeFrames(int count, int substeps);
  bool makeFrame(int substeps);
  bool makeSubstep(const SubstepPlan& plan, double done, int divisions);
  void moveReference();
  void movePinsAsIn(const ClothState& state) noexcept;
  int stableSubsteps() const noexcept;

  Motion& motion_;
  StepControls& controls_;
  FrameLoop& loop_;
  Budget& budget_;
  ErrorEstimate estimate_;
  Reference reference_;
  Motion::Checkpoint start_;  // the motion, during a trial run
  StepTally tally_;           // of the present trial run
};

}  // namespace curtain
