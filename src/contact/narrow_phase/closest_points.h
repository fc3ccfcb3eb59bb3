// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 3: closest points of a point and a triangle and of two segments, for any finite input: a triangle without area
// counts as its edges, a segment without length as its point. Called some 1e5 times a frame by the cloth's contact with
// itself: no allocation, no loops.
#pragma once

#include "curtain_sim/scene.h"

namespace curtain {

/// The point of a triangle that is closest to a given one.
struct TriangleClosest {
  Vec3 weights;             ///< barycentric, each >= 0, their sum 1 (within rounding)
  double distance_squared;  ///< [m^2]
};

/// Closest point of the triangle (a, b, c) to p; all finite, any unit, squares of squares of lengths must not overflow.
/// Where several points are closest: one of them, always the same. Thread-safe.
TriangleClosest closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) noexcept;

/// The points of two segments that are closest to each other.
struct SegmentsClosest {
  double s;                 ///< along the first segment [0..1]
  double t;                 ///< along the second segment [0..1]
  double distance_squared;  ///< [m^2]
};

/// Closest points of the segments a-b and c-d; as for closestOnTriangle().
SegmentsClosest closestOnSegments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept;

}  // namespace curtain
