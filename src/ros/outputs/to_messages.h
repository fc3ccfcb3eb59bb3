// SPDX-License-Identifier: BSD-3-Clause
//
// The engine's state as the parts of messages. Needs no ROS master.
#pragma once

#include <curtain_sim/Statistics.h>

#include <vector>

#include "curtain_sim/fine_mesh.h"
#include "curtain_sim/statistics.h"

namespace curtain_ros {

/// Flat xyz, as CurtainState holds its arrays; out is resized.
void flatten(const std::vector<curtain::Vec3>& points, std::vector<float>& out);

/// Flat xyz of the second-layer nodes of a fine mesh, in the order that CurtainState documents; out is resized.
void flattenFolds(const curtain::FineMeshTopology& topology, const curtain::FineMesh& mesh, std::vector<float>& out);

/// The engine's part of the statistics; the node's own fields are left as they are.
void toMessage(const curtain::Statistics& statistics, curtain_sim::Statistics& message);

}  // namespace curtain_ros
