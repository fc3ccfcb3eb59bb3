// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 6: the command line of curtain_batch. Everything that can be judged without a simulator is judged here, before
// anything is written.
#pragma once

#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain_batch {

extern const char* const kUsage;

struct Options {
  std::vector<std::string> scenes;  ///< paths; one, or any number with check
  double duration = 1.0;            ///< [s]
  std::string method, out, wrenches, mesh, stats, save, restore, checkpoint;
  double every = 10.0;  ///< between two checkpoints, simulated [s]
  int substeps = 0, rows = 0, columns = 0;
  std::vector<double> samples;  ///< [s], not decreasing
  double sample_rate = 0.0;     ///< samples a second instead, from the run's start on [1/s]; 0: none
  bool progress = false;
  bool explain = false;
  bool check = false;
  bool list_methods = false;
  bool version = false;
  bool help = false;
};

/// Throws std::invalid_argument naming the option and what is wrong.
Options readOptions(int argc, char** argv);

/// Throws std::invalid_argument unless the samples lie within the duration, which begins at a simulated time [s].
void checkSamples(const Options& options, double start);

/// Times of --sample-rate in a run that begins at a simulated time [s].
std::vector<double> samplesFrom(double start, const Options& options);

/// A scene file with what the options put in its place; the simulator judges the whole. Throws std::invalid_argument
/// with every problem of the file.
curtain::Scene readScene(const std::string& path, const Options& options);

}  // namespace curtain_batch
