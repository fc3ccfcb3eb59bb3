// SPDX-License-Identifier: BSD-3-Clause
//
// Brute-force oracle: is any part of the cloth inside an obstacle, or stuck through it? For tests and statistics.
#pragma once

#include <vector>

#include "cloth/cloth.h"
#include "cloth/coarse_mesh.h"
#include "contact/shapes/obstacle_set.h"
#include "curtain_sim/statistics.h"

namespace curtain {

/// Judges the first layer's mesh (every face cut along one diagonal, which counts as an edge) at one instant.
///   place            the obstacle's frame in the world
///   depth_tolerance  [m], >= 0: parts less deep than this do not count
/// A part of the cloth counts when its deepest point lies deeper than the tolerance in a convex solid. Of a watertight
/// mesh, edges count that are so deep anywhere (sampled between the crossings of its surface); of a shell, which has no
/// inside, edges that go through one of its triangles and end further than the tolerance from that triangle's plane on
/// both sides. Faces count when one of their edges does, or an edge of the mesh goes through them in the same way.
/// Cloth that is wholly on the wrong side of a shell can't be told from cloth on the right one.
/// Every element against every triangle whose box touches its own; allocates. Padding nodes are not looked at.
Piercings countPiercings(const ContactShape& shape, const Transform& place, const Grid& grid, const Field3& position,
                         double depth_tolerance);

/// The same for any triangle mesh; `triangles` are indices into `points` [m], world frame. Points that no triangle has
/// are not looked at. Triangles without area are fine.
Piercings countPiercings(const ContactShape& shape, const Transform& place, const std::vector<Vec3>& points,
                         const std::vector<MeshTriangle>& triangles, double depth_tolerance);

}  // namespace curtain
