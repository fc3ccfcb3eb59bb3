// SPDX-License-Identifier: BSD-3-Clause
//
// The scenes that all engines get: ours as a scene, the others the same cloth as a start.
#pragma once

#include <string>
#include <vector>

#include "bench/contestant.h"
#include "curtain_sim/scene.h"

namespace curtain_bench {

struct EngineScene {
  std::string name;
  curtain::Scene scene;
  ClothStart flat;   ///< as ours starts: slack where it is gathered
  ClothStart waves;  ///< the same without slack: of gathered cloth each row in five waves; else as flat
  int frames = 0;
  bool touches_itself = false;  ///< settings say whether it does
};

std::vector<EngineScene> engineScenes();

}  // namespace curtain_bench
