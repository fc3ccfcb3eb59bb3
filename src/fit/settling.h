// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 8: samples that settle under their weight: the engine's own frames, without contact and sleep, of a pattern
// that no scene describes.
#pragma once

#include "simulator/frame_loop.h"

namespace curtain_fit {

/// Not thread-safe. scene and pattern must outlive it.
class Settling {
 public:
  Settling(const curtain::Scene& scene, const curtain::ClothPattern& pattern)
      : rate_(scene.solver.frame_rate),
        times_(rate_),
        motion_(scene, pattern, times_, {}),
        controls_(scene.solver, pattern, scene.gravity),
        loop_(motion_, controls_, budget_) {}

  /// The next frame of 1/60 s.
  void step();
  double time() const { return times_.begin(); }                  ///< simulated [s]
  double kinetic() { return motion_.energy().kinetic; }           ///< [J]
  curtain::Field3& position() { return motion_.state.position; }  ///< [m]; to be changed before the first frame only

 private:
  double rate_;  // [1/s]
  curtain::FrameTimes times_;
  curtain::Motion motion_;
  curtain::StepControls controls_;
  curtain::Budget budget_{0.0};
  curtain::FrameLoop loop_;
};

}  // namespace curtain_fit
