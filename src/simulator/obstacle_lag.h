// SPDX-License-Identifier: BSD-3-Clause
//
// Obstacles wait for cloth that cannot give way: further on they might go through it. In the last resort those near the
// cloth go no further than a node may, and what is inside one comes out by no more, so that all that is asked of the
// solve vanishes with the reach.
#pragma once

#include "contact/cloth_contact.h"
#include "simulator/frame_times.h"
#include "solver/exact_solver.h"

namespace curtain {

class ObstacleLag {
 public:
  /// All but the pattern must outlive this.
  ObstacleLag(const ClothPattern& pattern, const FrameTimes& times, ObstacleSet& obstacles, ClothContact& contact);

  /// Moves the obstacles over a substep from `done` seconds into the frame.
  void setSubstep(const SubstepPlan& plan, double done, const Field3& position) noexcept;
  /// That substep of h [s] was made, over this share of its path. Returns the motion of obstacles that it put off [s].
  double substepMade(double share, double h) noexcept;
  /// share: of the frame that was made. What was put off is part of the next frame.
  void endFrame(double share) noexcept;

 private:
  const FrameTimes& times_;
  ObstacleSet& obstacles_;
  ClothContact& contact_;
  const double shortest_link_;  // [m]
  double share_ = 1.0;          // of the substep's motion that obstacles make
  double lag_ = 0.0;            // in this frame [s]
};

}  // namespace curtain
