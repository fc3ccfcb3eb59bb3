// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "obstacles/mesh_loader.h"
#include "obstacles/shapes.h"
#include "obstacles/triangle_mesh.h"

namespace curtain {
namespace {

/// validate() checks whole scenes; this guards shapes built without it.
double positive(const ObstacleParams& obstacle, const std::string& key, double value) {
  if (!(value > 0.0 && std::isfinite(value))) {
    std::ostringstream text;
    text << "obstacle '" << obstacle.name << "': " << key << " must be finite and > 0, is " << value;
    throw std::invalid_argument(text.str());
  }
  return value;
}

}  // namespace

std::unique_ptr<const ContactShape> makeContactShape(const ObstacleParams& obstacle, const MeshResolver& resolve) {
  switch (obstacle.shape) {
    case ShapeKind::kSphere:
      return std::make_unique<const SphereShape>(positive(obstacle, "radius", obstacle.radius));
    case ShapeKind::kBox:
      for (int axis = 0; axis < 3; ++axis) positive(obstacle, "size", obstacle.size[axis]);
      return std::make_unique<const BoxShape>(obstacle.size);
    case ShapeKind::kCylinder:
      return std::make_unique<const CylinderShape>(positive(obstacle, "radius", obstacle.radius),
                                                   positive(obstacle, "length", obstacle.length));
    case ShapeKind::kCapsule:
      return std::make_unique<const CapsuleShape>(positive(obstacle, "radius", obstacle.radius),
                                                  positive(obstacle, "length", obstacle.length));
    case ShapeKind::kPlane:
      return std::make_unique<const PlaneShape>();
    case ShapeKind::kMesh:
      return std::make_unique<const TriangleMeshShape>(loadMesh(obstacle, resolve));
  }
  throw std::invalid_argument("obstacle '" + obstacle.name + "': unknown shape");
}

std::unique_ptr<const ObstacleShape> makeObstacleShape(const ObstacleParams& obstacle, const MeshResolver& resolve) {
  return makeContactShape(obstacle, resolve);
}

}  // namespace curtain
