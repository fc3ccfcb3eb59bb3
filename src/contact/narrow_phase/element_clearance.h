// SPDX-License-Identifier: BSD-3-Clause
//
// Clearance of a small patch of triangles from an obstacle, yes or no with early outs. The fine mesh asks it for many
// candidate positions of a fold.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/coarse_mesh.h"
#include "obstacles/obstacle_set.h"

namespace curtain {

/// Holds scratch buffers only. Not thread-safe; allocates nothing once it has seen the largest patch and obstacle.
class ElementClearance {
 public:
  /// Whether no point of the triangles is nearer to the surface than `clearance` [m, >= 0] or inside a convex solid. Of
  /// a mesh only the surface counts: a connected patch with one corner outside is then wholly outside.
  ///   points     [m], world frame, finite
  ///   triangles  indices into points; two equal corners make it an edge
  bool keeps(const ContactShape& shape, const Transform& place, const std::vector<Vec3>& points,
             const std::vector<MeshTriangle>& triangles, double clearance);

 private:
  bool keepsToConvex(const ConvexShape& shape, const std::vector<MeshTriangle>& triangles, double clearance);
  bool keepsToMesh(const ObstacleFeatures& features, const std::vector<MeshTriangle>& triangles, double clearance);

  std::vector<Vec3> local_;
  std::vector<double> heights_;
  std::vector<std::uint32_t> near_;  // mesh triangles whose plane does not separate them from the patch
};

}  // namespace curtain
