// SPDX-License-Identifier: BSD-3-Clause
//
// Where the cloth is nearest to an obstacle. On demand: contact keeps no distances of what is out of its reach.
#pragma once

#include "cloth/cloth.h"
#include "curtain_sim/statistics.h"
#include "obstacles/contact_shape.h"
#include "obstacles/obstacle_set.h"

namespace curtain {

/// The least distance between the first layer's mesh (each quad is split along one diagonal) and an obstacle.
///   place     the obstacle's frame in the world
///   position  of the nodes [m], world frame; padding nodes are ignored
/// Convex solid: exact, negative where the cloth is inside, then of its deepest point. Mesh: between nodes, edges and
/// faces of both; negative where a node is inside a closed one. Allocates; thread-safe.
ObstacleDistance distanceTo(const ContactShape& shape, const Transform& place, const Grid& grid,
                            const Field3& position);

}  // namespace curtain
