// SPDX-License-Identifier: BSD-3-Clause
//
// Cloth that only its weight moves, and nothing damps, has no more energy than it had. Leapfrog keeps that as long as
// its substeps are all alike; where their lengths follow the tensions, as automatic ones do, every change sets the
// energy a little off, and a whip that makes it change at the same phases collects that: 0.2 m g H in 10 s of a sheet
// let go at 70 degrees. What is too much is taken out of the velocities at the frame's end.
#pragma once

#include <optional>

#include "simulator/motion.h"
#include "simulator/step_controls.h"

namespace curtain {

class EnergyGuard {
 public:
  /// chooses: nothing else asks for substeps. motion and controls must outlive this.
  EnergyGuard(Motion& motion, StepControls& controls, bool chooses);

  /// Before the first frame of a motion that nothing puts energy into.
  void beginFrame(bool pins_move) {
    if (!most_) endFrame(pins_move);
  }
  void endFrame(bool pins_move);
  /// Something has put energy in.
  void forget() noexcept { most_.reset(); }
  void carry(Archive& archive);

 private:
  bool isClosed(bool pins_move) const noexcept;
  double energyWithoutLinks() const noexcept;

  Motion& motion_;
  StepControls& controls_;
  const bool wanted_;
  const double total_mass_;     // [kg]
  std::optional<double> most_;  // while nothing puts any in [J]
};

}  // namespace curtain
