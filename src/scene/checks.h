// SPDX-License-Identifier: BSD-3-Clause
//
// The parts of validate(), for callers whose log already has problems: consequences of an unreadable value are not
// reported.
#pragma once

#include "scene/problem_log.h"

namespace curtain {

/// Adds all problems of the scene's values to the log.
void checkScene(const Scene& scene, ProblemLog& log);

/// Checks that the links can have their lengths at the start (hang, hem_width; without a rail).
void checkStart(const Scene& scene, ProblemLog& log);

/// Checks that rail, carriers and cloth fit together.
void checkRail(const Scene& scene, ProblemLog& log);

/// Checks that lines and tie-backs belong to nodes of the whole cloth (wholeCloth()) and have an end.
void checkLines(const Scene& scene, const ClothParams& whole, ProblemLog& log);

/// Checks what a hand takes, beside its single values.
void checkHold(const GraspParams& grasp, const ClothParams& cloth, const std::string& key, ProblemLog& log);

/// Checks that row and column are on the grid, unless the grid's size is wrong.
void checkNodeOnGrid(const NodeIndex& node, const ClothParams& cloth, const std::string& key, ProblemLog& log);

}  // namespace curtain
