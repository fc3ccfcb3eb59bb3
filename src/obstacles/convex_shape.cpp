// SPDX-License-Identifier: BSD-3-Clause
//
// Time of impact by conservative advancement. The supporting plane at the nearest point (a combination of two tangents
// where the distance has a kink) bounds the distance from below, so nothing happens before a corner passes it, nor
// before the fastest corner has covered the distance. (The minimum distance is not convex in time: a triangle that
// turns can come near twice.)
#include "obstacles/convex_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "obstacles/cutting_planes.h"
#include "obstacles/directions.h"
#include "scene/infinity.h"

namespace curtain {
namespace {

using cutting_planes::kEps;
using cutting_planes::largestCoordinate;
using cutting_planes::middleOf;

/// Longest displacement in a step [m]; its square would overflow beyond.
constexpr double kLongestStep = 1e150;

/// A path through a solid shorter than this share of its size touches an edge and does not enter: a start on an edge
/// rounds to either side. Rounding is 1e-15 of the size, and 1e-12 m is nothing to a cloth.
constexpr double kTouch = 1e-12;

/// Newton steps to an entry. Convergence is quadratic, but along a grazing path each step only halves the rest; one
/// that grazes to 2^-60 of its length does not enter.
constexpr int kMaxSteps = 60;

/// Shortest useful step of an advancement [share of the motion].
constexpr double kMinAdvance = 1e-7;

/// Time until the first corner passes the plane that supports the element [share of the motion].
template <std::size_t N>
double timeToPlane(const std::array<Vec3, N>& corners, const std::array<Vec3, N>& displacements,
                   const ElementMinimum& nearest, double safe_distance) {
  const double clearance = nearest.support_bound - safe_distance;
  if (!(clearance > 0.0)) return 0.0;
  std::array<double, N> heights;
  for (std::size_t k = 0; k < N; ++k) heights[k] = nearest.support.dot(corners[k] - corners[0]);
  const double lowest = *std::min_element(heights.begin(), heights.end());
  double time = kInfinity;
  for (std::size_t k = 0; k < N; ++k) {
    const double rate = nearest.support.dot(displacements[k]);
    if (rate < 0.0) time = std::min(time, (heights[k] - lowest + clearance) / -rate);
  }
  return time;
}

}  // namespace

bool ConvexShape::query(const Vec3& previous, const Vec3& current, double reach, SurfacePoint& out) const noexcept {
  const SurfacePoint surface = nearest(current, previous);
  const Vec3 move = current - previous;
  // The distance changes by at most the displacement: beyond it nothing was touched.
  if (surface.distance <= move.lpNorm<1>()) {
    double length = 0.0;
    const Vec3 direction = unitOr<Vec3>(move, Vec3::UnitZ(), length);
    Entry entry;
    if (length > 0.0 && length < kLongestStep && enter(previous, direction, length, entry)) {
      const double depth = entry.normal.dot(current - entry.point);
      const bool passed = surface.distance >= 0.0 || surface.normal.dot(entry.normal) < kSameSide;
      if (depth < 0.0 && passed) {
        out.distance = depth;
        out.normal = entry.normal;
        return true;
      }
    }
  }
  if (surface.distance > reach) return false;
  out = surface;
  return true;
}

/// Newton's method on the distance along the path. A start within the solid does not enter.
bool ConvexShape::enter(const Vec3& start, const Vec3& direction, double length, Entry& entry) const noexcept {
  double travelled = 0.0;
  Vec3 point = start;
  for (int n = 0; n < kMaxSteps; ++n) {
    const SurfacePoint surface = nearest(point);
    if (n == 0 && surface.distance < 0.0) return false;
    const double slope = surface.normal.dot(direction);
    if (!(slope < 0.0)) return false;  // from here on the path leads away
    if (surface.distance <= 4.0 * kEps * (point.cwiseAbs().maxCoeff() + size_)) {
      entry = {point, surface.normal};
      return nearest(point + kTouch * (size_ + length) * direction).distance < 0.0;
    }
    const double step = surface.distance / -slope;
    travelled += step;
    if (!(travelled <= length)) return false;
    point += step * direction;
  }
  return false;
}

Eigen::AlignedBox3d ConvexShape::bounds() const {
  Vec3 low, high;
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = -support(-Vec3::Unit(axis));
    high[axis] = support(Vec3::Unit(axis));
  }
  return {low, high};
}

void ConvexShape::minimise(const std::array<Vec3, 3>& corners, double reach, ElementMinimum& out) const noexcept {
  cutting_planes::searchTriangle(*this, size_, corners, reach, out);
}

void ConvexShape::minimise(const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) const noexcept {
  cutting_planes::searchEdge(*this, size_, ends, reach, out);
}

template <std::size_t N>
bool ConvexShape::findMinimum(const std::array<Vec3, N>& corners, double reach, ElementMinimum& out) const noexcept {
  // Early out: the tangent plane at the centre may exclude the whole element.
  const Vec3 middle = middleOf(corners);
  const SurfacePoint surface = nearest(middle);
  double lower = kInfinity;
  for (const Vec3& corner : corners) lower = std::min(lower, surface.distance + surface.normal.dot(corner - middle));
  if (lower > reach) return false;
  minimise(corners, reach, out);
  return out.point.lower_bound <= reach;
}

bool ConvexShape::nearestOnTriangle(const std::array<Vec3, 3>& corners, double reach,
                                    ElementPoint& out) const noexcept {
  ElementMinimum minimum;
  if (!findMinimum(corners, reach, minimum)) return false;
  out = minimum.point;
  return true;
}

bool ConvexShape::nearestOnEdge(const std::array<Vec3, 2>& ends, double reach, ElementPoint& out) const noexcept {
  ElementMinimum minimum;
  if (!findMinimum(ends, reach, minimum)) return false;
  out = minimum.point;
  return true;
}

template <std::size_t N>
std::optional<double> ConvexShape::advance(const std::array<Vec3, N>& start, const std::array<Vec3, N>& end,
                                           double min_distance) const noexcept {
  std::array<Vec3, N> displacements;
  double speed = 0.0;
  for (std::size_t k = 0; k < N; ++k) {
    displacements[k] = end[k] - start[k];
    speed = std::max(speed, displacements[k].template lpNorm<1>());  // >= the length, and cannot overflow
  }
  const double rounding = 32.0 * kEps * (largestCoordinate(start) + largestCoordinate(end) + std::abs(min_distance));
  const double safe_distance = min_distance + rounding;
  double time = 0.0;
  for (int n = 0; n < kMaxAdvances; ++n) {
    std::array<Vec3, N> corners;
    for (std::size_t k = 0; k < N; ++k) corners[k] = start[k] + time * displacements[k];
    ElementMinimum nearest;
    if (!findMinimum(corners, safe_distance + (1.0 - time) * speed, nearest)) return std::nullopt;
    const double clearance = nearest.point.lower_bound - safe_distance;
    if (!(clearance > 0.0)) return time;
    const double step = std::max(clearance / speed, timeToPlane(corners, displacements, nearest, safe_distance));
    if (!(time + step <= 1.0)) return std::nullopt;
    time += step;
    if (step < kMinAdvance) return time;
  }
  return time;
}

std::optional<double> ConvexShape::timeOfImpact(const std::array<Vec3, 3>& start, const std::array<Vec3, 3>& end,
                                                double min_distance) const noexcept {
  return advance(start, end, min_distance);
}

std::optional<double> ConvexShape::timeOfImpact(const std::array<Vec3, 2>& start, const std::array<Vec3, 2>& end,
                                                double min_distance) const noexcept {
  return advance(start, end, min_distance);
}

}  // namespace curtain
