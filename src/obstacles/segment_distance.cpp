// SPDX-License-Identifier: BSD-3-Clause
#include "obstacles/segment_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "obstacles/cutting_planes.h"
#include "scene/infinity.h"

namespace curtain {
namespace {

using cutting_planes::kEps;
using cutting_planes::largestCoordinate;
using cutting_planes::longestEdge;
using cutting_planes::middleOf;

/// Triangles lower than this share of their longest edge count as their edges, with a relative error as large.
constexpr double kFlatTriangle = 1e-8;

template <std::size_t N>
Vec3 pointAt(const std::array<Vec3, N>& corners, const std::array<double, 3>& weights) {
  Vec3 point = weights[0] * corners[0];
  for (std::size_t k = 1; k < N; ++k) point += weights[k] * corners[k];
  return point;
}

/// Best candidate for the nearest point.
struct Candidate {
  std::array<double, 3> weights{1.0, 0.0, 0.0};
  double distance_squared = kInfinity;

  void offer(const std::array<double, 3>& w, double squared) {
    if (!(squared < distance_squared)) return;
    weights = w;
    distance_squared = squared;
  }
};

std::array<double, 3> onEdge(std::size_t from, std::size_t to, double t) {
  std::array<double, 3> weights{};
  weights[from] += 1.0 - t;
  weights[to] += t;
  return weights;
}

/// Parameter [0..1] of the point of a segment nearest to a point.
double footOn(const Vec3& start, const Vec3& along, const Vec3& point) {
  const double square = along.squaredNorm();
  return square > 0.0 ? std::clamp(along.dot(point - start) / square, 0.0, 1.0) : 0.0;
}

/// Barycentric coordinates of a point's projection, if it is in the triangle.
bool footIn(const std::array<Vec3, 3>& corners, const Vec3& point, std::array<double, 3>& weights) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double square = normal.squaredNorm();
  const double longest = longestEdge(corners);
  if (!(std::sqrt(square) > kFlatTriangle * longest * longest)) return false;
  const std::array<Vec3, 3> d{corners[0] - point, corners[1] - point, corners[2] - point};
  for (std::size_t k = 0; k < 3; ++k) {
    weights[k] = normal.dot(d[(k + 1) % 3].cross(d[(k + 2) % 3])) / square;
    if (!(weights[k] >= 0.0)) return false;
  }
  const double sum = weights[0] + weights[1] + weights[2];
  for (double& weight : weights) weight /= sum;
  return true;
}

void nearestToPoint(const std::array<Vec3, 3>& corners, const Vec3& point, Candidate& best) {
  std::array<double, 3> weights{};
  if (footIn(corners, point, weights)) {
    best.offer(weights, (pointAt(corners, weights) - point).squaredNorm());
    return;
  }
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Vec3 along = corners[next] - corners[k];
    const double t = footOn(corners[k], along, point);
    best.offer(onEdge(k, next, t), (corners[k] + t * along - point).squaredNorm());
  }
}

/// Edge (from, to) of an element against the segment from `start` along `axis`: each end against the other segment,
/// and the common perpendicular if both its feet are inside.
void nearestToSegment(const Vec3& a, const Vec3& b, std::size_t from, std::size_t to, const Vec3& start,
                      const Vec3& axis, Candidate& best) {
  const Vec3 along = b - a;
  for (const double end : {0.0, 1.0}) {
    const Vec3 tip = start + end * axis;
    const double t = footOn(a, along, tip);
    best.offer(onEdge(from, to, t), (a + t * along - tip).squaredNorm());
    const Vec3 corner = a + end * along;
    const double s = footOn(start, axis, corner);
    best.offer(onEdge(from, to, end), (start + s * axis - corner).squaredNorm());
  }
  const double aa = along.squaredNorm();
  const double bb = axis.squaredNorm();
  const double ab = along.dot(axis);
  const double determinant = aa * bb - ab * ab;
  if (!(determinant > kEps * aa * bb)) return;  // parallel: an end is as near
  const Vec3 between = start - a;
  const double t = (along.dot(between) * bb - axis.dot(between) * ab) / determinant;
  const double s = (along.dot(between) * ab - axis.dot(between) * aa) / determinant;
  if (!(t > 0.0 && t < 1.0 && s > 0.0 && s < 1.0)) return;
  best.offer(onEdge(from, to, t), (a + t * along - start - s * axis).squaredNorm());
}

/// Where the segment from `start` along `axis` crosses the triangle, if it does.
void pierce(const std::array<Vec3, 3>& corners, const Vec3& start, const Vec3& axis, Candidate& best) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double slope = normal.dot(axis);
  const double height = normal.dot(corners[0] - start);
  if (slope == 0.0) return;
  const double s = height / slope;
  std::array<double, 3> weights{};
  if (!(s >= 0.0 && s <= 1.0) || !footIn(corners, start + s * axis, weights)) return;
  best.offer(weights, (pointAt(corners, weights) - start - s * axis).squaredNorm());
}

/// Scales by a power of two, which is exact, so that squares neither over- nor underflow.
template <std::size_t N>
double normalise(std::array<Vec3, N>& corners, double size) {
  const double factor = std::ldexp(1.0, -std::ilogb(std::max({largestCoordinate(corners), size, 1e-290})));
  for (Vec3& corner : corners) corner *= factor;
  return factor;
}

/// Minimum from the weights of the nearest point; least: smallest value of the distance [m], where it has no gradient.
template <std::size_t N>
void finish(const ConvexShape& shape, const std::array<Vec3, N>& corners, double least, double size,
            const std::array<double, 3>& weights, ElementMinimum& out) {
  const Vec3 point = pointAt(corners, weights);
  const double rounding = 16.0 * kEps * (largestCoordinate(corners) + size);
  out.point.weights = weights;
  out.point.surface = shape.nearest(point, middleOf(corners));
  const double distance = out.point.surface.distance;
  if (distance <= least + rounding) {
    out.support.setZero();
    out.point.lower_bound = out.support_bound = least - rounding;
    return;
  }
  out.support = out.point.surface.normal;
  double lower = distance;
  for (const Vec3& corner : corners) lower = std::min(lower, distance + out.support.dot(corner - point));
  out.support_bound = lower - rounding;
  out.point.lower_bound = std::max(lower, distance - 2.0 * kFlatTriangle * longestEdge(corners)) - rounding;
}

}  // namespace

void minimiseAroundSegment(const ConvexShape& shape, double radius, double half, const std::array<Vec3, 3>& corners,
                           ElementMinimum& out) noexcept {
  std::array<Vec3, 3> scaled = corners;
  const Vec3 tip = normalise(scaled, half) * half * Vec3::UnitZ();
  Candidate best;
  nearestToPoint(scaled, tip, best);
  if (half > 0.0) {
    nearestToPoint(scaled, -tip, best);
    pierce(scaled, -tip, 2.0 * tip, best);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      nearestToSegment(scaled[k], scaled[next], k, next, -tip, 2.0 * tip, best);
    }
  }
  finish(shape, corners, -radius, radius + half, best.weights, out);
}

void minimiseAroundSegment(const ConvexShape& shape, double radius, double half, const std::array<Vec3, 2>& ends,
                           ElementMinimum& out) noexcept {
  std::array<Vec3, 2> scaled = ends;
  const Vec3 tip = normalise(scaled, half) * half * Vec3::UnitZ();
  Candidate best;
  if (half > 0.0) {
    nearestToSegment(scaled[0], scaled[1], 0, 1, -tip, 2.0 * tip, best);
  } else {
    best.offer(onEdge(0, 1, footOn(scaled[0], scaled[1] - scaled[0], Vec3::Zero())), 0.0);
  }
  finish(shape, ends, -radius, radius + half, best.weights, out);
}

}  // namespace curtain
