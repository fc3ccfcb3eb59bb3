// SPDX-License-Identifier: BSD-3-Clause
//
// Queries of a triangle mesh by a bounding volume hierarchy: nearest triangle to a point, first triangle hit by a
// segment.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "contact/shapes/box_tree.h"
#include "curtain_sim/obstacle_shape.h"

namespace curtain {

/// The part of a triangle (a, b, c) that a nearest point lies on.
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

/// The triangles nearest to a point, the nearest first: while it does not go far, its nearest one is among the first of
/// them.
struct NearTriangles {
  static constexpr std::size_t kMost = 16;
  Vec3 centre = Vec3::Zero();  ///< the point [m]
  double radius = -1.0;        ///< all others are at least that far from it; negative: nothing is known [m]
  std::size_t count = 0;
  std::array<double, kMost> distances{};      ///< [m]
  std::array<std::uint32_t, kMost> places{};  ///< in the tree
};

/// Nearest point of the triangle (a, b, c), which may not have zero area; fills all but `triangle`.
NearestTriangle nearestOnTriangle(const Vec3& point, const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

class TriangleMeshTree {
 public:
  /// Finite triangles of nonzero area, at least one. O(n log n).
  explicit TriangleMeshTree(const ShapeTriangles& mesh);

  /// Nearest triangle not further than sqrt(limit_squared), of several the first in the input; false: none. Allocates
  /// nothing.
  bool nearest(const Vec3& point, double limit_squared, NearestTriangle& out) const noexcept;
  /// The same answer, sooner where `near` was found for a point nearby; finds it anew where it does not do, with so
  /// much room for the point to move [m].
  bool nearest(const Vec3& point, double limit_squared, double room, NearTriangles& near,
               NearestTriangle& out) const noexcept;

  /// First triangle on the way from -> to, both sides count; false: none. Does not slip through between
  /// triangles that share an edge. Triangles the segment touches at less than `least_fraction` do not count.
  bool firstHit(const Vec3& from, const Vec3& to, double least_fraction, TriangleHit& out) const noexcept;

  Eigen::AlignedBox3d bounds() const { return tree_.bounds(); }

 private:
  struct Triangle {
    std::array<Vec3, 3> corners;
    std::uint32_t index;
  };

  bool take(const Vec3& point, std::uint32_t place, NearestTriangle& best) const noexcept;
  void collect(const Vec3& point, double radius, NearTriangles& near) const noexcept;

  BoxTree tree_;
  std::vector<Triangle> triangles_;  // in the order of its leaves
  double margin_ = 0.0;              // widens boxes for segments, so that rounding never prunes a hit [m]
};

}  // namespace curtain
