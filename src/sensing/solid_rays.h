// SPDX-License-Identifier: BSD-3-Clause
//
// Where a ray meets a sphere, box, cylinder, capsule or plane: not the facets that they are drawn with. All are convex,
// so a ray is inside from one parameter to another; where solids overlap (a cylinder is a slab and a tube, a capsule a
// cylinder and two balls) these are cut or joined.
#pragma once

#include <optional>

#include "curtain_sim/scene.h"

namespace curtain {

/// Where a ray meets a surface.
struct SolidHit {
  double distance = 0.0;  ///< parameter along the ray, in lengths of its direction
  Vec3 normal;            ///< outward, unit
};

/// The first point of the surface along a ray, after the parameter `nearest`; none: it is missed.
///   shape      valid, not a mesh; its padding is not part of what is seen
///   origin     [m], direction  of any length > 0; both in the shape's frame
std::optional<SolidHit> firstHit(const ObstacleParams& shape, const Vec3& origin, const Vec3& direction,
                                 double nearest);

}  // namespace curtain
