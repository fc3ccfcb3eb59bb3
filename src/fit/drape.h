// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 8: the drape test of textile laboratories (Cusick 1968; BS 5058, ISO 9073-9), virtual: a round sample of 30 cm
// lies on a disc of 18 cm, and what hangs over the disc's edge falls into folds. The disc holds what lies on it: nodes
// there are pinned. The round sample is cut from a square grid by mass: each cell counts by its share in the circle.
#pragma once

#include <cstdint>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain_fit {

/// Radii of Cusick's sample and of the disc under it [m].
constexpr double kSampleRadius = 0.15, kDiscRadius = 0.09;

/// How the test is made.
struct DrapeTest {
  int nodes = 48;                                   ///< along a side of the grid [8..4096]
  int starts = 5;                                   ///< how often it is made, each time from another start, >= 1
  int substeps = 0;                                 ///< a frame of 1/60 s [0..10000]; 0: as many as the cloth needs
  curtain::Method method = curtain::Method::kAuto;  ///< how motion is computed
  double longest = 10.0;                            ///< simulated time after which it ends in any case [s], > 0
  std::uint64_t seed = 1;                           ///< of the first start; each next one has the next
};

/// What one start came to.
struct DrapeReading {
  double coefficient = 0.0;  ///< share of the ring around the disc that the shadow keeps, [0..1]
  int folds = 0;             ///< places where the rim stands out
  /// Height of the rim where it meets the warp and the weft through the middle, mean of both ends; the disc's is 0 [m].
  double warp_height = 0.0, weft_height = 0.0;
  double seconds = 0.0;  ///< simulated until it was at rest [s]
  bool at_rest = false;  ///< false: it still moved when the time was over
};

/// Makes the test for cloth with these properties; its size and its shape are not read. One reading a start. Starts run
/// side by side on the processor's cores; the readings do not depend on that. Throws std::invalid_argument for
/// properties that a scene must not have.
std::vector<DrapeReading> drape(const curtain::ClothParams& cloth, const DrapeTest& test);

/// Mean and standard deviation of some readings' coefficients; mean of their folds.
struct DrapeSummary {
  double mean = 0.0, spread = 0.0, folds = 0.0;
};
DrapeSummary summaryOf(const std::vector<DrapeReading>& readings);

}  // namespace curtain_fit
