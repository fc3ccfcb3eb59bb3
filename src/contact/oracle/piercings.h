// SPDX-License-Identifier: BSD-3-Clause
//
// Brute-force oracle: parts of the cloth inside an obstacle, or crossing it. For tests and statistics.
#pragma once

#include <vector>

#include "cloth/cloth.h"
#include "cloth/coarse_mesh.h"
#include "curtain_sim/statistics.h"
#include "obstacles/obstacle_set.h"

namespace curtain {

/// Counts parts of the first layer's mesh (each quad is split along one diagonal, which counts as an edge) at one
/// instant.
///   place            the obstacle's frame in the world
///   depth_tolerance  [m], >= 0: parts less deep than this do not count
/// Convex solid: a part counts if its deepest point is deeper than the tolerance. Watertight mesh: an edge counts if it
/// is so deep anywhere, sampled between its crossings of the surface. Shell, which has no inside: an edge counts if it
/// crosses a triangle and ends further than the tolerance from its plane on both sides. A face counts if one of its
/// edges does, or if an edge of the mesh crosses it in the same way. Cloth wholly on the wrong side of a shell is not
/// detected. All elements against all triangles with overlapping boxes; allocates. Padding nodes are ignored.
Piercings countPiercings(const ContactShape& shape, const Transform& place, const Grid& grid, const Field3& position,
                         double depth_tolerance);

/// The same for any triangle mesh: `triangles` are indices into `points` [m], world frame. Points without a triangle
/// are ignored; triangles may have zero area.
Piercings countPiercings(const ContactShape& shape, const Transform& place, const std::vector<Vec3>& points,
                         const std::vector<MeshTriangle>& triangles, double depth_tolerance);

}  // namespace curtain
