// SPDX-License-Identifier: BSD-3-Clause
//
// Does a small patch of triangles keep its distance to an obstacle? Yes or no, as early as possible: for the fine mesh,
// which asks it of many places a fold could take.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/coarse_mesh.h"
#include "contact/shapes/obstacle_set.h"

namespace curtain {

/// Holds buffers only. Not thread-safe; allocates nothing once it has seen the largest patch and obstacle.
class ElementClearance {
 public:
  /// Whether no point of the triangles is nearer to the obstacle's surface than `clearance` [m, >= 0], or, of a convex
  /// solid, inside it. Of a mesh only the surface counts: a patch that hangs together and has one corner outside is
  /// then wholly outside.
  ///   points     [m], world frame, finite
  ///   triangles  indices into points; two equal corners make an edge of it
  bool keeps(const ContactShape& shape, const Transform& place, const std::vector<Vec3>& points,
             const std::vector<MeshTriangle>& triangles, double clearance);

 private:
  bool keepsToConvex(const ConvexShape& shape, const std::vector<MeshTriangle>& triangles, double clearance);
  bool keepsToMesh(const ObstacleFeatures& features, const std::vector<MeshTriangle>& triangles, double clearance);

  std::vector<Vec3> local_;
  std::vector<double> heights_;
  std::vector<std::uint32_t> near_;  // triangles of the mesh whose plane does not part it from the patch
};

}  // namespace curtain
