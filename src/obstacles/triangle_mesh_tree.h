// SPDX-License-Identifier: BSD-3-Clause
//
// Queries of a triangle mesh by a bounding volume hierarchy: nearest triangle to a point, first triangle hit by a
// segment.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "curtain_sim/obstacle_shape.h"
#include "obstacles/box_tree.h"

namespace curtain {

/// Feature of a triangle (a, b, c) that holds a nearest point.
enum class TriangleFeature : std::uint8_t { kFace, kEdgeAb, kEdgeBc, kEdgeCa, kCornerA, kCornerB, kCornerC };

struct NearestTriangle {
  double distance_squared = 0.0;  ///< [m^2]
  Vec3 point = Vec3::Zero();      ///< on the triangle [m]
  std::uint32_t triangle = 0;     ///< index in the tree's input
  TriangleFeature feature = TriangleFeature::kFace;
};

struct TriangleHit {
  double fraction = 0.0;       ///< of the segment [0..1]
  std::uint32_t triangle = 0;  ///< index in the tree's input
};

/// Cache: the triangles nearest to a point, sorted by distance. While the point moves little, its nearest one is among
/// the first.
struct NearTriangles {
  static constexpr std::size_t kMost = 16;
  Vec3 centre = Vec3::Zero();  ///< where it was found [m]
  double radius = -1.0;        ///< all others are at least this far away; negative: empty [m]
  std::size_t count = 0;
  std::array<double, kMost> distances{};      ///< [m]
  std::array<std::uint32_t, kMost> places{};  ///< indices in the tree
};

/// Nearest point of the triangle (a, b, c), which may not have zero area; fills all but `triangle`.
NearestTriangle nearestOnTriangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

class TriangleMeshTree {
 public:
  /// Finite triangles of nonzero area, at least one. O(n log n).
  explicit TriangleMeshTree(const ShapeTriangles& mesh);

  /// Nearest triangle within sqrt(limit_squared), of equal ones the first in the input; false: none. Allocates
  /// nothing.
  bool nearest(const Vec3& point, double limit_squared, NearestTriangle& out) const noexcept;
  /// The same answer, faster if `near` was found for a nearby point; refreshes it otherwise, with a margin for motion
  /// of `room` [m].
  bool nearest(const Vec3& point, double limit_squared, double room, NearTriangles& near,
               NearestTriangle& out) const noexcept;

  /// First triangle on the path from -> to, from either side; false: none. No path slips between triangles that share
  /// an edge. Hits before `min_fraction` do not count.
  bool firstHit(const Vec3& from, const Vec3& to, double min_fraction, TriangleHit& out) const noexcept;

  Eigen::AlignedBox3d bounds() const { return tree_.bounds(); }

 private:
  struct Triangle {
    std::array<Vec3, 3> corners;
    std::uint32_t index;
  };

  bool improve(const Vec3& point, std::uint32_t place, NearestTriangle& best, double& squared) const noexcept;
  void collect(const Vec3& point, double radius, NearTriangles& near) const noexcept;

  BoxTree tree_;
  std::vector<Triangle> triangles_;  // in the order of its leaves
  double margin_ = 0.0;              // grows boxes, so that rounding never prunes a hit [m]
};

}  // namespace curtain
