// SPDX-License-Identifier: BSD-3-Clause
//
// The step controls of a scene's method. leapfrog4 has two: its own, for substeps of five stages (composition.h), and
// that of auto, for where stages cannot be made.
#pragma once

#include <cmath>

#include "step/step_control.h"

namespace curtain {

struct StepControls {
  StepControls(const SolverParams& params, const ClothPattern& pattern, const Vec3& gravity)
      : main(params, pattern, gravity), plain(asAuto(params), pattern, gravity) {}

  void reset() noexcept {
    both([](StepControl& control) { control.reset(); });
    plain_frames = 0;
  }
  /// Calls change(control) for both.
  template <typename Change>
  void both(const Change& change) {
    for (StepControl* control : {&main, &plain}) change(*control);
  }
  /// Makes no stages for a second: strings that pull now and then would change the scheme all the time, and every
  /// change shakes them.
  void pauseStages(double frame_rate) noexcept {
    if (plain_frames == 0) plain_frames = static_cast<int>(std::ceil(frame_rate));
  }
  void beginFrame() noexcept {
    if (plain_frames > 0) --plain_frames;
  }
  void serialize(Archive& archive);

  StepControl main, plain;
  int plain_frames = 0;  // left before leapfrog4 makes stages again

 private:
  static SolverParams asAuto(SolverParams params) {
    params.method = Method::kAuto;
    params.substeps = 0;
    return params;
  }
};

}  // namespace curtain
