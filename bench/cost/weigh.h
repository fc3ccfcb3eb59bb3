// SPDX-License-Identifier: BSD-3-Clause
//
// Runs curtain_cost, by itself for the time a frame takes and under callgrind for its instructions, which are the same
// in every run and on every machine of one instruction set.
#pragma once

#include <string>

#include "bench/cost/features.h"

namespace curtain_bench {

struct Weight {
  double instructions = 0.0;  ///< per node and frame
  double ns = 0.0;            ///< per node and frame: median of the frames
  double substeps = 0.0;      ///< per frame
  std::string state_hash;     ///< at the end
};

/// Without the time. Throws std::runtime_error when valgrind is missing or a run fails.
Weight weigh(const Feature& feature, FeatureState state);

/// Without the instructions.
Weight clockOf(const Feature& feature, FeatureState state);

}  // namespace curtain_bench
