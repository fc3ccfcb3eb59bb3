// SPDX-License-Identifier: BSD-3-Clause
//
// Directions of a quad's edges and faces while it moves. What is nearest to an edge of the cloth is across it and, seen
// from an edge of the obstacle, between the normals of its two faces: so the cloth's edge rises from one of these faces
// and falls to the other. Of a fine mesh that leaves the few edges at which the surface turns away from the cloth's
// edge. The same for a corner below a face: all its edges go away from the face.
#pragma once

#include <array>
#include <cstdint>

#include "cloth/coarse_mesh.h"
#include "obstacles/normal_cone.h"
#include "obstacles/obstacle_features.h"

namespace curtain {

/// Immutable, so thread-safe. All in the obstacle's frame. False is certain, but for what the solve changes of the path
/// that is looked at: within a fiftieth of a radian, everything may be nearest.
class SweptDirections {
 public:
  SweptDirections(const QuadElements& quad, const Field3& start, const Field3& end) noexcept;

  /// Whether some edge of the quad may have its nearest point at an edge between faces with such normals.
  bool edgesMeet(const NormalCone& normals) const noexcept;
  /// The same of an edge of the quad, by its number.
  bool edgeMeets(int edge, const ObstacleEdge& other) const noexcept;
  /// Whether some face of the quad may have its nearest point at a corner of faces with such normals.
  bool facesMeet(const NormalCone& normals) const noexcept;
  /// The same of a face of the quad, by its number, and a vertex of `features`.
  bool faceMeets(int face, std::uint32_t vertex, const ObstacleFeatures& features) const noexcept;

 private:
  /// Between start and end it is in between.
  struct Edge {
    std::array<Vec3, 2> along;
    double longest;  // [m]
  };
  /// Its normal, not unit, is a Bezier curve of the second degree: between start and end it is within the three.
  struct Face {
    std::array<Vec3, 3> normals;
    double longest;  // [m^2]
    Vec3 middle;     // all three are within `around` of it, and so is the normal whenever it is looked at
    double around;
  };

  int edge_count_, face_count_;
  std::array<Edge, 5> edges_;
  std::array<Face, 2> faces_;
};

}  // namespace curtain
