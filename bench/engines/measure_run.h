// SPDX-License-Identifier: BSD-3-Clause
//
// One run of a scene by one engine: what its frames take, how far off its links are, and what it has let through.
#pragma once

#include <cstdint>

#include "bench/contestant.h"
#include "bench/engines/engine.h"
#include "curtain_sim/scene.h"

namespace curtain_bench {

struct Figures {
  double ms_median = 0.0, ms_99 = 0.0;  ///< of a frame
  double stretch_max = 0.0;             ///< largest misfit of a link at any frame's end, as largestStretch() has it
  double stretch_rms = 0.0;             ///< of all links at all frames' ends
  int nodes_inside = 0;                 ///< the ball, most at any frame's end
  double deepest = 0.0;                 ///< of them [m]
  std::int64_t crossings = 0;           ///< edges that cross triangles at the end
};

/// Ends at a state that is not sound, and misfits are NaN. engine: the contestant, if its air is computed outside of
/// it, which the clock does not see; else null.
Figures figuresOf(const ClothStart& start, const curtain::Scene& scene, int frames, Contestant& contestant,
                  Engine* engine);

}  // namespace curtain_bench
