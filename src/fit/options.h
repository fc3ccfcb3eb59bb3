// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 8: the command line of curtain_fit. What can be judged without a simulation is judged here.
#pragma once

#include <optional>
#include <string>

#include "fit/drape.h"
#include "fit/laboratory.h"

namespace curtain_fit {

extern const char* const kUsage;

struct Options {
  Laboratory laboratory;
  std::optional<Quantity> drape_coefficient;  ///< measured [1]
  std::string material, scene;                ///< fabric to start from: a name, or a path; empty: none
  bool drape = false;                         ///< make the drape test and nothing else
  DrapeTest test;
  bool version = false;
  bool help = false;
};

/// Throws std::invalid_argument naming the option and what is wrong.
Options readOptions(int argc, char** argv);

/// The fabric that the options describe. Throws std::invalid_argument with every problem of a scene file, or naming
/// what is missing.
Preset presetOf(const Options& options);

}  // namespace curtain_fit
