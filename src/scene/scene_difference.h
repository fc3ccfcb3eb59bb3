// SPDX-License-Identifier: BSD-3-Clause
//
// Where two scenes, as YAML text, differ first.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// The first key, in the order of `ours`, that differs in `theirs`, with both values; none: they are equal.
/// ours    from writeScene()
/// theirs  any text
/// aside   keys that may differ, lists without their index: "air", "obstacles[].mesh"
std::optional<Problem> firstDifference(const std::string& ours, const std::string& theirs,
                                       const std::vector<std::string>& aside);

}  // namespace curtain
