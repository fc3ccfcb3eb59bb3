// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: what runs for the scene and what is skipped, in the log at level DEBUG.
#pragma once

#include "curtain_sim/simulator.h"

namespace curtain_ros {

class PlanLog {
 public:
  /// Once a frame, after it; simulation thread only. Logs the plan when it is another than last time; looks about once
  /// a second, and not at all unless the level is on.
  void update(const curtain::Simulator& simulator);

 private:
  curtain::Plan last_;
  int frames_ = 0;  // to go
};

}  // namespace curtain_ros
