// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 6: what a run needs to go on where it was, as one file: a snapshot, and beside it what the outputs are made of.
// A run that is done leaves a checkpoint of its last frame. Started again it goes on from there like any other: it has
// no frame left to make and writes what it writes at the end.
//
//   magic          18 letters and an end of line
//   version        32-bit
//   length         64-bit, of all of it [bytes]
//   members        as Archive writes them
//   checksum       32-bit CRC of all before it
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "batch/options.h"
#include "batch/table_file.h"
#include "curtain_sim/simulator.h"
#include "simulator/export.h"

namespace curtain_batch {

/// What a run has beside its simulator.
struct Progress {
  curtain::RunSums sums;  ///< of its frames so far
  TableMark states;       ///< of --out
  TableMark wrenches;     ///< of --wrenches
};

/// What must be the same for a checkpoint to be this run's: options and their values, and the scene as text.
struct RunIdentity {
  std::vector<std::pair<std::string, std::string>> options;
  std::string scene;
};

/// simulator: at the run's start.
RunIdentity identityOf(const Options& options, const curtain::Simulator& simulator);

/// Throws std::runtime_error when the file can't be written; then an older one stays. It is written completely or not
/// at all, and is on the disk afterwards.
void writeCheckpoint(const std::string& path, const RunIdentity& run, const curtain::Simulator& simulator,
                     const Progress& progress);

/// False: there is no such file. Throws std::invalid_argument for a file that is no checkpoint, is damaged, or is of
/// another run or build; then nothing changed.
bool readCheckpoint(const std::string& path, const RunIdentity& run, curtain::Simulator& simulator, Progress& progress);

/// Removes what a run that was killed between naming a new file and renaming it has left beside the file. Only one run
/// at a time may write it.
void removeLeftovers(const std::string& path);

}  // namespace curtain_batch
