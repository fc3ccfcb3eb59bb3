// SPDX-License-Identifier: BSD-3-Clause
//
// Minimum of a convex distance over an edge or a triangle by cutting planes (Kelley 1960, "The cutting-plane method for
// solving convex programs", in one dimension, nested for triangles). Each tangent is below the distance, and two with
// slopes of opposite signs bound the minimum between them:
//
//      \       /            On a row of the triangle (s fixed, t free) the two tangent planes combine to one that is
//       \__ __/  distance   level along t: a tangent of the row's minimum as a function of s, which is convex again.
//       \  v  /  tangents   So the outer search uses cutting planes, too, and its bound holds for the whole triangle.
//          ^ lower bound
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "obstacles/convex_shape.h"

namespace curtain {
namespace cutting_planes {

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// Most evaluations of a row, and rows of a triangle. Brackets halve at least every second time: 2^-30.
constexpr int kMaxTangents = 60;

template <std::size_t N>
double largestCoordinate(const std::array<Vec3, N>& corners) {
  double largest = 0.0;
  for (const Vec3& corner : corners) largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  return largest;
}

template <std::size_t N>
Vec3 middleOf(const std::array<Vec3, N>& corners) {
  Vec3 middle = corners[0] / static_cast<double>(N);
  for (std::size_t k = 1; k < N; ++k) middle += corners[k] / static_cast<double>(N);
  return middle;
}

/// Between 1 and 1.8 times the longest edge.
template <std::size_t N>
double longestEdge(const std::array<Vec3, N>& corners) {
  double longest = 0.0;
  for (std::size_t k = 0; k < N; ++k)
    longest = std::max(longest, (corners[(k + 1) % N] - corners[k]).template lpNorm<1>());
  return longest;
}

/// A tangent of a function of one variable, and the plane below the distance that it comes from: distance(x) >= base +
/// gradient . (x - first corner) everywhere.
struct Tangent {
  double at;
  double value;
  double slope;
  Vec3 gradient;
  double base;
};

/// Combination of two tangents of opposite slopes that is level along their variable; the one tangent of a search that
/// ended at an end of its range.
inline Tangent mixed(const Tangent& left, const Tangent& right) {
  if (!(left.slope < 0.0 && right.slope > 0.0)) return left;
  const double share = right.slope / (right.slope - left.slope);
  return {left.at, left.value, 0.0, share * left.gradient + (1.0 - share) * right.gradient,
          share * left.base + (1.0 - share) * right.base};
}

/// Result of a search: two tangents whose upper envelope bounds the minimum (twice the same at an end).
struct Valley {
  Tangent left;
  Tangent right;
  double lower;
};

/// Searches the minimum on [0, end]. tangentAt(x) -> Tangent; enough(lower): whether a lower bound is good enough.
template <typename TangentAt, typename Enough>
Valley searchValley(double end, TangentAt&& tangentAt, Enough&& enough) {
  Tangent left = tangentAt(0.0);
  if (left.slope >= 0.0) return {left, left, left.value};
  Tangent right = tangentAt(end);
  if (right.slope <= 0.0) return {right, right, right.value};
  double width = end;  // of the bracket two steps ago
  for (int n = 0;; ++n) {
    const double gap = right.at - left.at;
    // Relative to the bracket, against cancellation.
    const double meet =
        std::clamp((right.value - left.value - right.slope * gap) / (left.slope - right.slope), 0.0, gap);
    const double lower = left.value + left.slope * meet;
    if (n == kMaxTangents || enough(lower) || !(gap > kEps * end)) return {left, right, lower};
    double next = std::clamp(meet, 0.05 * gap, 0.95 * gap);
    if (n % 2 == 1) {
      if (gap > 0.5 * width) next = 0.5 * gap;
      width = gap;
    }
    const Tangent middle = tangentAt(left.at + next);
    if (middle.slope == 0.0) return {middle, middle, middle.value};
    (middle.slope < 0.0 ? left : right) = middle;
  }
}

/// Best point so far, and the stopping criterion.
class Search {
 public:
  Search(double tolerance, double reach) : tolerance_(tolerance), reach_(reach) {}

  void offer(const std::array<double, 3>& weights, const SurfacePoint& surface) {
    if (surface.distance < best_.surface.distance || !found_) {
      best_.weights = weights;
      best_.surface = surface;
      found_ = true;
    }
  }
  /// Whether a lower bound excludes a better point, or any within reach.
  bool enough(double lower, double share) const {
    return lower >= best_.surface.distance - share * tolerance_ || lower > reach_;
  }
  /// The best point, with the plane that bounds the minimum.
  template <std::size_t N>
  ElementMinimum best(const std::array<Vec3, N>& corners, const Tangent& plane, double rounding) const {
    ElementMinimum minimum;
    minimum.point = best_;
    double lower = plane.base;
    for (std::size_t k = 1; k < N; ++k) {
      lower = std::min(lower, plane.base + plane.gradient.dot(corners[k] - corners[0]));
    }
    minimum.support = plane.gradient;
    minimum.support_bound = lower - rounding;
    minimum.point.lower_bound = std::min(lower, best_.surface.distance) - rounding;
    return minimum;
  }

 private:
  double tolerance_;
  double reach_;
  ElementPoint best_;
  bool found_ = false;
};

/// Minimum on an edge. shape.nearest(point, beside) gives the distance and a subgradient; `beside` is the centre of
/// the element, so that its exit is on the side of most of it. size: of the shape [m], for rounding.
template <typename Shape>
void searchEdge(const Shape& shape, double size, const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) {
  const Vec3 along = ends[1] - ends[0], middle = middleOf(ends);
  const double rounding = 16.0 * kEps * (largestCoordinate(ends) + size);
  Search search(0.5 * kElementAccuracy * longestEdge(ends) + rounding, reach + rounding);
  const auto tangentAt = [&](double t) -> Tangent {
    const SurfacePoint surface = shape.nearest(ends[0] + t * along, middle);
    search.offer({1.0 - t, t, 0.0}, surface);
    const double slope = surface.normal.dot(along);
    return {t, surface.distance, slope, surface.normal, surface.distance - t * slope};
  };
  const Valley valley = searchValley(1.0, tangentAt, [&](double lower) { return search.enough(lower, 1.0); });
  out = search.best(ends, mixed(valley.left, valley.right), rounding);
}

/// The same on a triangle.
template <typename Shape>
void searchTriangle(const Shape& shape, double size, const std::array<Vec3, 3>& corners, double reach,
                    ElementMinimum& out) {
  const Vec3 along_s = corners[1] - corners[0];
  const Vec3 along_t = corners[2] - corners[0];
  const Vec3 middle = middleOf(corners);
  const double rounding = 16.0 * kEps * (largestCoordinate(corners) + size);
  Search search(0.5 * kElementAccuracy * longestEdge(corners) + 4.0 * rounding, reach + rounding);
  const auto rowTangent = [&](double s) -> Tangent {
    const double end = std::max(1.0 - s, 0.0);
    const Vec3 start = corners[0] + s * along_s;
    const auto tangentAt = [&](double t) -> Tangent {
      const SurfacePoint surface = shape.nearest(start + t * along_t, middle);
      search.offer({std::max(end - t, 0.0), s, t}, surface);
      const double slope = surface.normal.dot(along_t);
      const double base = surface.distance - t * slope - s * surface.normal.dot(along_s);
      return {t, surface.distance, slope, surface.normal, base};
    };
    // A row that cannot be better needs no exact minimum, only a tangent.
    const Valley row = searchValley(end, tangentAt, [&](double lower) { return search.enough(lower, 0.25); });
    const Tangent level = mixed(row.left, row.right);
    // The row's minimum is where the plane is level, or at its start (t = 0 in all rows), or at its end, which moves
    // by -1 with s.
    const Vec3 along_start = level.slope < 0.0 ? Vec3(along_s - along_t) : along_s;
    return {s, row.lower, level.gradient.dot(along_start), level.gradient, level.base};
  };
  const Valley valley = searchValley(1.0, rowTangent, [&](double lower) { return search.enough(lower, 1.0); });
  out = search.best(corners, mixed(valley.left, valley.right), rounding);
}

}  // namespace cutting_planes
}  // namespace curtain
