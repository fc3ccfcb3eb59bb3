// SPDX-License-Identifier: BSD-3-Clause
//
// An obstacle's shape as contact sees it: beside the nearest point also the flat features, or the convex solid, that
// cloth elements are tested against.
#pragma once

#include <memory>

#include "curtain_sim/obstacle_shape.h"

namespace curtain {

class ConvexShape;
class ObstacleFeatures;

class ContactShape : public ObstacleShape {
 public:
  /// Corners, edges and triangles of an obstacle with flat faces (box, mesh), else nullptr. Lives as long as the shape.
  virtual const ObstacleFeatures* features() const noexcept { return nullptr; }

  /// The shape itself when it is one of the analytic convex ones, which know their distance to edges and triangles;
  /// nullptr for meshes.
  virtual const ConvexShape* convex() const noexcept { return nullptr; }
};

/// makeObstacleShape(), with what contact needs.
std::unique_ptr<const ContactShape> makeContactShape(const ObstacleParams& obstacle, const MeshResolver& resolve);

}  // namespace curtain
