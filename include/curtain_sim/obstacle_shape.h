// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 3: the shapes an obstacle can have, each in its own frame. A shape answers one query: the nearest point of its
// surface to a node that has moved, with signed distance and outward normal.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// The nearest point of the surface, in the shape's frame.
struct SurfacePoint {
  double distance = 0.0;        ///< [m], negative inside
  Vec3 normal = Vec3::UnitZ();  ///< unit, outward (gradient of the distance)
};

/// Triangles of a shape for drawing: corners in the shape's frame [m], three indices a triangle.
struct ShapeTriangles {
  std::vector<Vec3> corners;               ///< [m]
  std::vector<Eigen::Vector3i> triangles;  ///< indices into corners
};

/// Geometry of an obstacle. Immutable after construction: any number of threads may query it.
class ObstacleShape {
 public:
  virtual ~ObstacleShape() = default;

  /// Nearest surface point to `current`, if it is nearer than `reach`, or `current` is inside, or the path from
  /// `previous` to `current` crosses the surface.
  ///   previous, current  positions of the point [m], shape's frame, finite; they may be equal
  ///   reach              [m], >= 0
  /// False: nothing within reach. Solid shapes and watertight meshes give the signed distance at `current`; open meshes
  /// are thin shells whose inside is the side away from `previous`. Allocates nothing, throws nothing.
  virtual bool query(const Vec3& previous, const Vec3& current, double reach, SurfacePoint& out) const noexcept = 0;

  /// Box around the surface [m], shape's frame; infinite for a plane.
  virtual Eigen::AlignedBox3d bounds() const = 0;

  /// Triangles for drawing; a plane gives a finite square around its origin.
  virtual ShapeTriangles triangles() const = 0;
};

/// Turns a mesh URL into a file path; returns "" when it can't.
using MeshResolver = std::function<std::string(const std::string& url)>;

/// package://NAME/… by ROS_PACKAGE_PATH (the folder NAME or the one whose package.xml has that name),
/// file:///… and file://localhost/… (RFC 8089), and plain paths as they are.
std::string resolveMeshUrl(const std::string& url);

/// Builds the shape of an obstacle. Throws std::invalid_argument naming obstacle, file and reason: a mesh
/// that is missing, empty, not readable, without area, or not finite.
std::unique_ptr<const ObstacleShape> makeObstacleShape(const ObstacleParams& obstacle,
                                                       const MeshResolver& resolve = resolveMeshUrl);

}  // namespace curtain
