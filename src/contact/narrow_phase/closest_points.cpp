// SPDX-License-Identifier: BSD-3-Clause
#include "contact/narrow_phase/closest_points.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace curtain {
namespace {

/// (height / longest edge)^2 below which a triangle is treated as its edges: 1e-10 of the longest edge.
constexpr double kNoHeight = 1e-20;

/// (height / longest edge)^2 below which the barycentric weights are refined once.
constexpr double kSliver = 1e-8;

double clampedRatio(double part, double whole) { return whole > 0.0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0; }

/// Keeps the closer of `best` and the closest point of the edge from corner i (at `start` from p) to corner j.
void closestOnEdge(const Vec3& start, const Vec3& edge, int i, int j, TriangleClosest& best) {
  const double along = clampedRatio(-start.dot(edge), edge.squaredNorm());
  const double distance_squared = (start + along * edge).squaredNorm();
  if (distance_squared < best.distance_squared) {
    best.distance_squared = distance_squared;
    best.weights.setZero();
    best.weights[i] = 1.0 - along;
    best.weights[j] = along;
  }
}

}  // namespace

TriangleClosest closestOnTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
  const Vec3 pa = a - p;
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 normal = ab.cross(ac);
  const double area = normal.squaredNorm();
  const double longest = std::max(ab.squaredNorm(), ac.squaredNorm());
  // Barycentric weights of p's projection, times `area`, by cross products, which avoid cancellation of squares.
  const Vec3 turned = normal.cross(pa);
  double of_b = -turned.dot(ac);
  double of_c = turned.dot(ab);
  const bool no_height = !(area > kNoHeight * longest * longest);
  if (!no_height && area < kSliver * longest * longest) {
    // For a sliver the projection is off by eps / height; one step of iterative refinement corrects that.
    const Vec3 left = normal.cross(pa + of_b / area * ab + of_c / area * ac);
    of_b -= left.dot(ac);
    of_c += left.dot(ab);
  }
  const double of_a = area - of_b - of_c;
  if (!no_height && of_a >= 0.0 && of_b >= 0.0 && of_c >= 0.0) {
    const double inverse = 1.0 / area;
    TriangleClosest face{{of_a * inverse, of_b * inverse, of_c * inverse}, 0.0};
    face.distance_squared = (pa + face.weights[1] * ab + face.weights[2] * ac).squaredNorm();
    return face;
  }
  // The closest point lies on an edge that separates the projection from the triangle.
  TriangleClosest best{{1.0, 0.0, 0.0}, pa.squaredNorm()};
  if (no_height || of_c < 0.0) closestOnEdge(pa, ab, 0, 1, best);
  if (no_height || of_b < 0.0) closestOnEdge(pa, ac, 0, 2, best);
  if (no_height || of_a < 0.0) closestOnEdge(pa + ab, ac - ab, 1, 2, best);
  return best;
}

SegmentsClosest closestOnSegments(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) noexcept {
  const Vec3 ab = b - a;
  const Vec3 cd = d - c;
  const Vec3 ac = c - a;
  const double ab_ab = ab.squaredNorm();
  const double cd_cd = cd.squaredNorm();
  const double ab_cd = ab.dot(cd);
  const double ac_ab = ac.dot(ab);
  const double ac_cd = ac.dot(cd);
  // Closest point of the lines, clamped to the first segment, by cross products: for near-parallel segments at an
  // angle theta s is off by eps / theta, which moves the distance by eps only. Parallel: any s will do.
  const Vec3 normal = ab.cross(cd);
  double s = clampedRatio(ac.cross(cd).dot(normal), normal.squaredNorm());
  // Clamped to the second, and back to the first: Ericson, Real-Time Collision Detection, 5.1.9.
  double t = clampedRatio(ab_cd * s - ac_cd, cd_cd);
  if (t == 0.0 || t == 1.0) s = clampedRatio(ab_cd * t + ac_ab, ab_ab);
  return {s, t, (s * ab - t * cd - ac).squaredNorm()};
}

}  // namespace curtain
