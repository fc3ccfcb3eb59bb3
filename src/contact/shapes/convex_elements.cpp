// SPDX-License-Identifier: BSD-3-Clause
//
// Edges and triangles of the cloth against the analytic convex obstacles.
//
// Nearest point: closed forms for plane, sphere and capsule (distance of the element to a corner, a point, a segment), the
// search of tangent_search.h for box and cylinder.
//
// Time of impact: conservative advancement. The plane that supports the nearest point (of two tangents, where the
// distance has a kink) bounds the distance of the whole space from below, so nothing happens until a corner comes through
// it; nor before the fastest corner has gone the distance. (The smallest distance is no convex function of time: a
// triangle that turns can come near twice.)
#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/shapes/shapes.h"
#include "contact/shapes/tangent_search.h"

namespace curtain {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
using tangents::kEps;
using tangents::largestCoordinate;
using tangents::longestEdge;
using tangents::middleOf;

/// Triangles lower than this share of their longest edge have their nearest point on an edge, to that share.
constexpr double kFlatTriangle = 1e-8;

/// Steps of time below which an advance is no advance.
constexpr double kLeastAdvance = 1e-7;

template <std::size_t N>
Vec3 pointAt(const std::array<Vec3, N>& corners, const std::array<double, 3>& weights) {
  Vec3 point = weights[0] * corners[0];
  for (std::size_t k = 1; k < N; ++k) point += weights[k] * corners[k];
  return point;
}

// ---- closed forms --------------------------------------------------------------------------------------------

/// A candidate for the nearest point; keeps the best.
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

/// Barycentric coordinates of the foot of the perpendicular from a point, if it lies in the triangle.
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

/// Edge (from, to) of an element against the segment from `start` along `axis`: every pair of an end and a segment, and
/// the common perpendicular if both its feet lie within.
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
  if (!(determinant > kEps * aa * bb)) return;  // parallel: an end does as well
  const Vec3 between = start - a;
  const double t = (along.dot(between) * bb - axis.dot(between) * ab) / determinant;
  const double s = (along.dot(between) * ab - axis.dot(between) * aa) / determinant;
  if (!(t > 0.0 && t < 1.0 && s > 0.0 && s < 1.0)) return;
  best.offer(onEdge(from, to, t), (a + t * along - start - s * axis).squaredNorm());
}

/// Where the segment from `start` along `axis` goes through the triangle, if it does.
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

/// Corners by a power of two, so that no square over- or underflows and no digit is lost.
template <std::size_t N>
double normalise(std::array<Vec3, N>& corners, double size) {
  const double factor = std::ldexp(1.0, -std::ilogb(std::max({largestCoordinate(corners), size, 1e-290})));
  for (Vec3& corner : corners) corner *= factor;
  return factor;
}

/// The minimum from the weights of the nearest point; `least`: no distance to the shape is smaller (nor differentiable
/// where it is that small).
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

template <std::size_t N>
std::array<double, 3> lowest(const std::array<Vec3, N>& corners) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < N; ++k) {
    if (corners[k].z() < corners[best].z()) best = k;
  }
  std::array<double, 3> weights{};
  weights[best] = 1.0;
  return weights;
}

/// Whether the tangent plane at the middle of an element leaves all of it out of reach.
template <std::size_t N>
bool isFar(const ConvexShape& shape, const std::array<Vec3, N>& corners, double reach) {
  const Vec3 middle = middleOf(corners);
  const SurfacePoint surface = shape.nearest(middle);
  double lower = kInfinity;
  for (const Vec3& corner : corners) lower = std::min(lower, surface.distance + surface.normal.dot(corner - middle));
  return lower > reach;
}

/// How long none of the corners, on their ways, comes through the plane that supports the element [time].
template <std::size_t N>
double timeToPlane(const std::array<Vec3, N>& corners, const std::array<Vec3, N>& ways, const ElementMinimum& nearest,
                   double least_distance) {
  const double free_way = nearest.support_bound - least_distance;
  if (!(free_way > 0.0)) return 0.0;
  std::array<double, N> heights;
  for (std::size_t k = 0; k < N; ++k) heights[k] = nearest.support.dot(corners[k] - corners[0]);
  const double lowest = *std::min_element(heights.begin(), heights.end());
  double time = kInfinity;
  for (std::size_t k = 0; k < N; ++k) {
    const double rate = nearest.support.dot(ways[k]);
    if (rate < 0.0) time = std::min(time, (heights[k] - lowest + free_way) / -rate);
  }
  return time;
}

template <typename Nearest, std::size_t N>
std::optional<double> advance(Nearest&& nearestOn, const std::array<Vec3, N>& start, const std::array<Vec3, N>& end,
                              double min_distance) {
  std::array<Vec3, N> ways;
  double speed = 0.0;
  for (std::size_t k = 0; k < N; ++k) {
    ways[k] = end[k] - start[k];
    speed = std::max(speed, ways[k].template lpNorm<1>());  // not less than the length, and cannot overflow
  }
  const double rounding = 32.0 * kEps * (largestCoordinate(start) + largestCoordinate(end) + std::abs(min_distance));
  const double least_distance = min_distance + rounding;
  double time = 0.0;
  for (int n = 0; n < ConvexShape::kMostAdvances; ++n) {
    std::array<Vec3, N> corners;
    for (std::size_t k = 0; k < N; ++k) corners[k] = start[k] + time * ways[k];
    ElementMinimum nearest;
    if (!nearestOn(corners, least_distance + (1.0 - time) * speed, nearest)) return std::nullopt;
    const double free_way = nearest.point.lower_bound - least_distance;
    if (!(free_way > 0.0)) return time;
    const double step = std::max(free_way / speed, timeToPlane(corners, ways, nearest, least_distance));
    if (!(time + step <= 1.0)) return std::nullopt;
    time += step;
    if (step < kLeastAdvance) return time;
  }
  return time;
}

}  // namespace

template <std::size_t N>
bool ConvexShape::findMinimum(const std::array<Vec3, N>& corners, double reach, ElementMinimum& out) const noexcept {
  if (isFar(*this, corners, reach)) return false;
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

std::optional<double> ConvexShape::timeOfImpact(const std::array<Vec3, 3>& start, const std::array<Vec3, 3>& end,
                                                double min_distance) const noexcept {
  return advance([this](const std::array<Vec3, 3>& corners, double reach,
                        ElementMinimum& out) { return findMinimum(corners, reach, out); },
                 start, end, min_distance);
}

std::optional<double> ConvexShape::timeOfImpact(const std::array<Vec3, 2>& start, const std::array<Vec3, 2>& end,
                                                double min_distance) const noexcept {
  return advance([this](const std::array<Vec3, 2>& ends, double reach,
                        ElementMinimum& out) { return findMinimum(ends, reach, out); },
                 start, end, min_distance);
}

void SphereShape::minimise(const std::array<Vec3, 3>& corners, double, ElementMinimum& out) const noexcept {
  std::array<Vec3, 3> scaled = corners;
  normalise(scaled, 0.0);
  Candidate best;
  nearestToPoint(scaled, Vec3::Zero(), best);
  finish(*this, corners, -radius_, radius_, best.weights, out);
}

void SphereShape::minimise(const std::array<Vec3, 2>& ends, double, ElementMinimum& out) const noexcept {
  std::array<Vec3, 2> scaled = ends;
  normalise(scaled, 0.0);
  finish(*this, ends, -radius_, radius_, onEdge(0, 1, footOn(scaled[0], scaled[1] - scaled[0], Vec3::Zero())), out);
}

void CapsuleShape::minimise(const std::array<Vec3, 3>& corners, double, ElementMinimum& out) const noexcept {
  std::array<Vec3, 3> scaled = corners;
  const Vec3 tip = normalise(scaled, half_) * half_ * Vec3::UnitZ();
  Candidate best;
  pierce(scaled, -tip, 2.0 * tip, best);
  nearestToPoint(scaled, -tip, best);
  nearestToPoint(scaled, tip, best);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    nearestToSegment(scaled[k], scaled[next], k, next, -tip, 2.0 * tip, best);
  }
  finish(*this, corners, -radius_, radius_ + half_, best.weights, out);
}

void CapsuleShape::minimise(const std::array<Vec3, 2>& ends, double, ElementMinimum& out) const noexcept {
  std::array<Vec3, 2> scaled = ends;
  const Vec3 tip = normalise(scaled, half_) * half_ * Vec3::UnitZ();
  Candidate best;
  nearestToSegment(scaled[0], scaled[1], 0, 1, -tip, 2.0 * tip, best);
  finish(*this, ends, -radius_, radius_ + half_, best.weights, out);
}

void PlaneShape::minimise(const std::array<Vec3, 3>& corners, double, ElementMinimum& out) const noexcept {
  finish(*this, corners, -kInfinity, 0.0, lowest(corners), out);
}

void PlaneShape::minimise(const std::array<Vec3, 2>& ends, double, ElementMinimum& out) const noexcept {
  finish(*this, ends, -kInfinity, 0.0, lowest(ends), out);
}

void BoxShape::minimise(const std::array<Vec3, 3>& corners, double reach, ElementMinimum& out) const noexcept {
  tangents::searchTriangle(*this, half_.maxCoeff(), corners, reach, out);
}

void BoxShape::minimise(const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) const noexcept {
  tangents::searchEdge(*this, half_.maxCoeff(), ends, reach, out);
}

void CylinderShape::minimise(const std::array<Vec3, 3>& corners, double reach, ElementMinimum& out) const noexcept {
  tangents::searchTriangle(*this, radius_ + half_, corners, reach, out);
}

void CylinderShape::minimise(const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) const noexcept {
  tangents::searchEdge(*this, radius_ + half_, ends, reach, out);
}

}  // namespace curtain
