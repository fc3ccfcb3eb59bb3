// SPDX-License-Identifier: BSD-3-Clause
//
// All the ways in which one value of a scene's text can be wrong: a visitor of fields.h, so that a new key takes part
// by itself.
#pragma once

#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain_test {

/// A key and a value that it must not have, as YAML; "" takes the key away.
struct Breakage {
  std::string key;  ///< dotted, e.g. "obstacles[0].motion[1].time"
  std::string value;
};

/// For every key that the scene's text has; at least one a key.
std::vector<Breakage> breakagesOf(const curtain::Scene& scene);

/// The scene's text with one value broken.
std::string breakText(const std::string& text, const Breakage& breakage);

}  // namespace curtain_test
