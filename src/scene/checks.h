// SPDX-License-Identifier: BSD-3-Clause
//
// validate() in pieces, for callers that have problems already: a log filled by the reader keeps what only follows
// from an unreadable value from being reported.
#pragma once

#include "scene/problem_log.h"

namespace curtain {

/// Everything wrong with the scene's values, added to the log.
void checkScene(const Scene& scene, ProblemLog& log);

/// Where the cloth starts: whether its links can be as long as they are (hang, hem_width).
void checkStart(const Scene& scene, ProblemLog& log);

/// Whether row and column are on the grid; nothing while the grid's own size is wrong.
void checkNodeOnGrid(const NodeIndex& node, const ClothParams& cloth, const std::string& key, ProblemLog& log);

}  // namespace curtain
