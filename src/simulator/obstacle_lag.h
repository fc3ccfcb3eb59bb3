// SPDX-License-Identifier: BSD-3-Clause
//
// Delays obstacles where the cloth cannot give way, since they might go through it. In the last resort those near the
// cloth move no further than the trust radius, and depenetration is bounded by it too, so that the solve becomes
// trivial as the radius shrinks.
#pragma once

#include "contact/cloth_contact.h"
#include "simulator/frame_times.h"
#include "step/step.h"

namespace curtain {

class ObstacleLag {
 public:
  /// All arguments but the pattern must outlive this.
  ObstacleLag(const ClothPattern& pattern, const FrameTimes& times, ObstacleSet& obstacles, ClothContact& contact);

  /// Sets the obstacles' motion for a substep from `done` seconds into the frame.
  void setSubstep(const SubstepPlan& plan, double done, const Field3& position) noexcept;
  /// The substep of h [s] was made, over this share of its path, which becomes that of the obstacles. Returns the delay
  /// of moving ones [s].
  double substepMade(double share, double h) noexcept;
  /// share: of the frame that was made. The delay becomes part of the next frame.
  void endFrame(double share) noexcept;

 private:
  const FrameTimes& times_;
  ObstacleSet& obstacles_;
  ClothContact& contact_;
  const double shortest_link_;  // [m]
  double from_ = 0.0;           // start of the obstacles' motion in the substep, as a share of the frame
  double share_ = 1.0;          // of that motion, in the substep
  double lag_ = 0.0;            // delay in this frame [s]
};

}  // namespace curtain
