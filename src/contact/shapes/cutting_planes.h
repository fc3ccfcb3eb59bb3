// SPDX-License-Identifier: BSD-3-Clause
//
// The smallest value of a convex distance on an edge or a triangle by tangents (Kelley 1960, "The cutting-plane method
// for solving convex programs", in one dimension, twice nested). Each tangent lies below the distance, and two that
// lean towards each other bound its minimum between them from below:
//
//      \       /          of a row of the triangle (s fixed, t free) the two tangent planes mix to one that is level
//       \__ __/  distance along t: a tangent of the row's minimum as a function of s, which is convex again. So the
//       \  v  /  tangents outer search works on tangents, too, and ends with a bound that holds for the whole triangle.
//          ^ lower bound
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "contact/shapes/convex_shape.h"

namespace curtain {
namespace cutting_planes {

constexpr double kEps = std::numeric_limits<double>::epsilon();

/// Evaluations of one row, or rows of a triangle, at most. Brackets halve at least every second time: 2^-30.
constexpr int kMostTangents = 60;

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

/// Not smaller than the longest edge, not larger than 1.8 times it.
template <std::size_t N>
double longestEdge(const std::array<Vec3, N>& corners) {
  double longest = 0.0;
  for (std::size_t k = 0; k < N; ++k)
    longest = std::max(longest, (corners[(k + 1) % N] - corners[k]).template lpNorm<1>());
  return longest;
}

/// A line below a convex function of one variable, and the plane below the distance that it is cut from: distance(x) >=
/// base + gradient . (x - first corner) everywhere.
struct Tangent {
  double at;
  double value;
  double slope;
  Vec3 gradient;
  double base;
};

/// The plane between two tangents that lean towards each other which is level along their variable, the only tangent of
/// a search that ended at an end of its range.
inline Tangent mixed(const Tangent& left, const Tangent& right) {
  if (!(left.slope < 0.0 && right.slope > 0.0)) return left;
  const double share = right.slope / (right.slope - left.slope);
  return {left.at, left.value, 0.0, share * left.gradient + (1.0 - share) * right.gradient,
          share * left.base + (1.0 - share) * right.base};
}

/// Where the search ended: two tangents whose lower envelope bounds the minimum (twice the same at an end).
struct Valley {
  Tangent left;
  Tangent right;
  double lower;
};

/// Searches the minimum on [0, end]. tangentAt(x) -> Tangent; enough(lower) says when a bound of the minimum will do.
template <typename TangentAt, typename Enough>
Valley searchValley(double end, TangentAt&& tangentAt, Enough&& enough) {
  Tangent left = tangentAt(0.0);
  if (left.slope >= 0.0) return {left, left, left.value};
  Tangent right = tangentAt(end);
  if (right.slope <= 0.0) return {right, right, right.value};
  double width = end;  // of the bracket two tangents ago
  for (int n = 0;; ++n) {
    const double gap = right.at - left.at;
    // In the bracket, not from the origin: that would cancel.
    const double meet =
        std::clamp((right.value - left.value - right.slope * gap) / (left.slope - right.slope), 0.0, gap);
    const double lower = left.value + left.slope * meet;
    if (n == kMostTangents || enough(lower) || !(gap > kEps * end)) return {left, right, lower};
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

/// Best point so far, and the rules when to stop.
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
  /// A bound this high can't hide a better point, or any within reach.
  bool enough(double lower, double share) const {
    return lower >= best_.surface.distance - share * tolerance_ || lower > reach_;
  }
  /// The best point, with the plane that shows that it is.
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

/// Minimum on an edge; shape.nearest(point, beside) gives the distance and its (sub)gradient: where an element lies on
/// both sides of a middle, out is where most of it is. `size`: of the shape, for rounding.
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
    // A row that can't be better needs no exact minimum, only a tangent.
    const Valley row = searchValley(end, tangentAt, [&](double lower) { return search.enough(lower, 0.25); });
    const Tangent level = mixed(row.left, row.right);
    // The row's minimum lies where the plane is level, or at its start, which all rows have at t = 0, or at its end,
    // which moves by -1 with s.
    const Vec3 way = level.slope < 0.0 ? Vec3(along_s - along_t) : along_s;
    return {s, row.lower, level.gradient.dot(way), level.gradient, level.base};
  };
  const Valley valley = searchValley(1.0, rowTangent, [&](double lower) { return search.enough(lower, 1.0); });
  out = search.best(corners, mixed(valley.left, valley.right), rounding);
}

}  // namespace cutting_planes
}  // namespace curtain
