// SPDX-License-Identifier: BSD-3-Clause
//
// solver.position_tolerance: chooses the substeps of a frame so that the motion's error keeps to it (ErrorEstimate).
// Pilot runs before the motion guess how many it needs; a reference run beside it, in other substeps, tells its error.
#pragma once

#include "simulator/error_estimate.h"
#include "simulator/frame_loop.h"

namespace curtain {

class ErrorControl {
 public:
  /// A tolerance is asked for, of a method whose error can be told.
  static bool wanted(const SolverParams& params) {
    return params.position_tolerance > 0.0 && ErrorEstimate::knows(params.method);
  }

  /// All of them must outlive this.
  ErrorControl(Motion& motion, StepControls& controls, FrameLoop& loop, Budget& budget);

  /// Before the motion begins: some frames of it, twice, to find the substeps that it needs.
  void makePilotRuns();
  /// Before a frame: moves the reference run ahead where one is due, and asks for substeps.
  void beginFrame();
  /// After it, before the next one begins. share: of the frame that was made.
  void endFrame(double share);
  /// The reference run starts anew, from the motion.
  void lose() noexcept { reference_.lost = true; }

  void reset() noexcept { estimate_.reset(); }
  /// The frames' length has changed.
  void takeFrame() noexcept;
  void carry(Archive& archive);

 private:
  struct Reference {
    Motion::Checkpoint at;
    int substeps = 0;   // a frame
    StepTally tally;    // of the last frame
    bool lost = false;  // a substep failed
    bool in_finer_steps = false;

    void carry(Archive& archive);
  };
  bool makeFrames(int count, int substeps);
  bool makeFrame(int substeps);
  bool makeSubstep(const SubstepPlan& plan, double done, int divisions);
  void moveReference();
  int stableSubsteps() const noexcept;

  Motion& motion_;
  StepControls& controls_;
  FrameLoop& loop_;
  Budget& budget_;
  ErrorEstimate estimate_;
  Reference reference_;
  Motion::Checkpoint start_;  // of the motion, meanwhile
  StepTally tally_;           // of the run that is made
};

}  // namespace curtain
