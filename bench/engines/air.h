// SPDX-License-Identifier: BSD-3-Clause
//
// The scene's wind, and its air damping beyond what grows with the velocity, as accelerations for engines that have no
// such air.
#pragma once

#include "bench/contestant.h"
#include "cloth/cloth.h"
#include "parts/wind/wind_source.h"

namespace curtain_bench {

class Air {
 public:
  explicit Air(const curtain::Scene& scene);

  /// Of the nodes at a time [m/s^2].
  void accelerations(const Points& positions, const Points& velocities, double time, Points& out);

 private:
  const curtain::Scene scene_;
  const curtain::ClothPattern pattern_;
  std::vector<curtain::WindSource> winds_;
  curtain::Field3 position_, area_vectors_, force_;
};

}  // namespace curtain_bench
