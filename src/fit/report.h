// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 8: what curtain_fit prints.
#pragma once

#include <string>
#include <vector>

#include "fit/drape.h"
#include "fit/laboratory.h"

namespace curtain_fit {

/// A preset as YAML that a scene can have, its notes as comments.
std::string yamlOf(const Preset& preset);

/// Readings as YAML: mean, spread and each start.
std::string yamlOf(const std::vector<DrapeReading>& readings, int nodes);

/// "61.9 % +- 2.3 (5 starts, 48 x 48 nodes)"
std::string describe(const std::vector<DrapeReading>& readings, int nodes);

/// A share in % with one digit behind the point.
std::string percent(double share);

}  // namespace curtain_fit
