// SPDX-License-Identifier: BSD-3-Clause
//
// The animation of a scene, as it is simulated.
#pragma once

#include "curtain_sim/scene.h"
#include "export/animation_writer.h"
#include "export/excerpt.h"

namespace curtain {

/// Runs a scene up to the excerpt's end, which it must have: cloth, and obstacles that are visible. Throws
/// std::invalid_argument with every problem of the scene, and where the excerpt has no frame in it. False: the state
/// became non-finite, and there it ends.
bool playScene(const Scene& scene, const Excerpt& excerpt, AnimationWriter& writer);

}  // namespace curtain
