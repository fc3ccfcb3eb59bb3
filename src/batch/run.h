// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 6: a run of curtain_batch, from its start or a checkpoint to its end.
#pragma once

#include "batch/checkpoint.h"
#include "batch/options.h"
#include "curtain_sim/simulator.h"

namespace curtain_batch {

/// Steps through the duration, or what a checkpoint leaves of it. Writes samples and checkpoints as their times come.
/// simulator: at the run's start, where --restore put it. Throws std::invalid_argument for a checkpoint that can't be
/// gone on from, with nothing written, and std::runtime_error when an output can't be written.
Progress makeRun(const Options& options, curtain::Simulator& simulator);

}  // namespace curtain_batch
