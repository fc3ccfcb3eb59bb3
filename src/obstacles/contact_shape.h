// SPDX-License-Identifier: BSD-3-Clause
//
// An obstacle's shape as contact needs it: the public interface, and what cloth elements are tested against.
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

  /// The shape itself if it is an analytic convex one, which can query edges and triangles; nullptr for meshes.
  virtual const ConvexShape* convex() const noexcept { return nullptr; }
};

/// As makeObstacleShape(), with the interface of contact.
std::unique_ptr<const ContactShape> makeContactShape(const ObstacleParams& obstacle, const MeshResolver& resolve);

}  // namespace curtain
