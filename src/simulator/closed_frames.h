// SPDX-License-Identifier: BSD-3-Clause
//
// Frames in which nothing puts energy in or takes it out, of undamped cloth that only gravity moves: what the scheme
// makes in them is taken out of the velocities at their ends. Leapfrog conserves energy while all substeps are alike;
// with automatic substeps every change of length shifts it a little, and a whip whose phases repeat collects the
// shifts: 0.2 m g H in 10 s of a sheet let go at 70 degrees.
#pragma once

#include "simulator/motion.h"
#include "simulator/step_controls.h"

namespace curtain {

class ClosedFrames {
 public:
  /// chooses: nothing else asks for substeps (position_tolerance does). motion and controls must outlive this.
  ClosedFrames(Motion& motion, StepControls& controls, bool chooses);

  /// Takes the energy at the start.
  void beginFrame() {
    if (!motion_.step.account().isClosed()) endFrame();
  }
  void endFrame();
  /// The pattern's pins have changed.
  void pinsChanged() noexcept;

 private:
  bool isClosed() const noexcept;
  double energyWithoutLinks() const noexcept;

  Motion& motion_;
  StepControls& controls_;
  const bool chooses_;
  bool wanted_;
  const double total_mass_;  // [kg]
};

}  // namespace curtain
