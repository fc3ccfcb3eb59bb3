// SPDX-License-Identifier: BSD-3-Clause
//
// Keeps the energy of undamped cloth that only gravity moves at or below its start. Leapfrog conserves it while all
// substeps are alike; with automatic substeps every change of length shifts it a little, and a whip whose phases repeat
// collects the shifts: 0.2 m g H in 10 s of a sheet let go at 70 degrees. Excess is taken out of the velocities at the
// frame's end.
#pragma once

#include <optional>

#include "simulator/motion.h"
#include "simulator/step_controls.h"

namespace curtain {

class EnergyGuard {
 public:
  /// chooses: nothing else asks for substeps (position_tolerance does). motion and controls must outlive this.
  EnergyGuard(Motion& motion, StepControls& controls, bool chooses);

  /// Before a frame: takes the energy at the start.
  void beginFrame(bool driven) {
    if (!most_) endFrame(driven);
  }
  void endFrame(bool driven);
  /// The pattern's pins have changed.
  void takePins() noexcept;
  /// Something has changed the energy.
  void forget() noexcept { most_.reset(); }
  void carry(Archive& archive);

 private:
  bool isClosed(bool driven) const noexcept;
  double energyWithoutLinks() const noexcept;

  Motion& motion_;
  StepControls& controls_;
  const bool chooses_;
  bool wanted_;
  const double total_mass_;     // [kg]
  std::optional<double> most_;  // bound of the energy [J]; none: not closed
};

}  // namespace curtain
