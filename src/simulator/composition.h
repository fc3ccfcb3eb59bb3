// SPDX-License-Identifier: BSD-3-Clause
//
// All parts of a simulator. Whoever adds one adds it here; the simulator's public functions that are of one part ask it
// by name (simulator/api), all else asks the list.
#pragma once

#include "parts/air/air_damping.h"
#include "parts/air/relative_air.h"
#include "parts/bending/bending.h"
#include "parts/cords/cords.h"
#include "parts/drag/drags.h"
#include "parts/hands/grasps.h"
#include "parts/hysteresis/hysteresis.h"
#include "parts/pins/scene_pins.h"
#include "parts/rail/rail.h"
#include "parts/shear/shear.h"
#include "parts/taut_columns/taut_columns.h"
#include "parts/twist/twist.h"
#include "parts/weft_push/weft_push.h"
#include "parts/wind/winds.h"
#include "step/elastic_chain.h"
#include "step/solver_parts.h"

namespace curtain {

struct Composition {
  // Must outlive this.
  const Scene& scene;
  const ClothPattern& pattern;
  const ObstacleSet& obstacles;
  const Workers& workers;

  Layers layers{scene};
  ScenePins pins{scene, pattern};
  Winds winds{scene, pattern, obstacles};
  AirDamping air_damping{scene.air, layers, pattern};
  Drags drags{scene, pattern};
  RelativeAir relative_air{scene.air, layers, pattern, scene.ambient};
  Grasps hands{scene, pattern};
  Bending bending{pattern, workers};
  Hysteresis hysteresis{layers, pattern};
  Shear shear{layers, pattern, workers};
  Twist twist{layers, pattern, workers};
  WeftPush weft_push{layers, pattern};
  Rail rail{scene, pattern};
  Cords cords{pattern};
  TautColumns taut_columns{scene, pattern};

  /// In the order in which they add their forces: relative_air reads those before it, taut_columns what they pin.
  // clang-format off
  const PartList all{
      &pins,
      &winds,
      &air_damping,
      &drags,
      &relative_air,
      &hands,
      &bending,
      &hysteresis,
      &shear,
      &twist,
      &weft_push,
      &rail,
      &cords,
      &taut_columns,
  };
  // clang-format on

  ElasticChain elastic{{&bending, &hysteresis, &shear, &twist, &weft_push}};

  SolverParts forSolver() noexcept { return {elastic.part(), rail.any() ? &rail : nullptr, {&cords}}; }
};

}  // namespace curtain
