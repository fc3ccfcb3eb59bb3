// SPDX-License-Identifier: BSD-3-Clause
//
// Both queries are one: the Minkowski difference of the two elements, the convex hull of the corners' differences w_i
// (three of a vertex and a triangle, four of two edges), against the origin. Each w_i moves straight, so along any
// fixed direction n its projection is linear in time, and n keeps the elements apart over exactly the times at which
// all n.w_i > min_distance |n|. This is conservative advancement (Mirtich 1996) with that bound in place of one on
// speeds:
//
//    n_0 = direction of the closest points at t = 0, apart until t_1
//    n_1 = direction of the closest points at t_1,   apart until t_2 > t_1 …
//
// ends where a direction lasts beyond 1 (none) or none is certain any more (impact). Where the elements turn, a
// direction that turns with them, from one of the closest points to the next, lasts longer: near an impact that makes
// it Newton's method. Only the times a direction lasts need to be certain; how the direction was found does not matter.
#include "curtain_sim/ccd.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/narrow_phase/closest_points.h"

namespace curtain {
namespace {

/// Unit of rounding u: one operation is off by no more than u times its result.
constexpr double kUnit = 0.5 * std::numeric_limits<double>::epsilon();

/// Steps before it is called an impact; what does not slide along at a few roundings takes a dozen at most.
constexpr int kMostSteps = 100;

/// Squared lengths below this may have lost digits to underflow.
constexpr double kLeastSquare = 1e-280;

/// A fixed direction that lasts for this share of the way to the predicted impact will do.
constexpr double kGood = 0.95;

/// A gap of this many times what it may be off by is no gap: the last steps would gain no more than that.
constexpr double kTouching = 4.0;

/// A step shorter than this is one of those [of the motion's time].
constexpr double kShortStep = 1e-9;

/// Sum of all coordinates beyond which products of four might overflow [m].
constexpr double kLargest = 1e75;

using Four = Eigen::Array4d;

/// Four points, one a lane.
struct Points {
  Four x, y, z;
  Vec3 point(int i) const { return {x[i], y[i], z[i]}; }
  void set(int i, const Vec3& point) {
    x[i] = point.x();
    y[i] = point.y();
    z[i] = point.z();
  }
  Four along(const Vec3& n) const { return x * n.x() + y * n.y() + z * n.z(); }
  Vec3 largest() const { return {x.abs().maxCoeff(), y.abs().maxCoeff(), z.abs().maxCoeff()}; }
  double sum() const { return (x.abs() + y.abs() + z.abs()).sum(); }
};

/// Directions that may keep a hull apart from the origin, the best first.
struct Directions {
  Vec3 refined;  ///< of the closest points, exactly across what they lie on: good down to distances of rounding
  Vec3 closest;  ///< of the closest points as computed
  Vec3 normal;   ///< of the plane, towards the hull
  Four weights;  ///< of the hull's points in the closest one
};

/// The hull of the corners' differences at both ends of the step.
class MovingHull {
 public:
  MovingHull(const Points& start, const Points& end, double min_distance)
      : start_(start), end_(end), min_distance_(min_distance) {}

  bool finite() const { return start_.sum() + end_.sum() + min_distance_ < kLargest; }

  /// Whether a coordinate axis keeps them apart all the time. A difference of two numbers has the sign of the exact one
  /// and is off by u of itself.
  bool apartAlongAxes() const {
    const double bound = min_distance_ * (1.0 + 4.0 * kUnit);
    return apart(start_.x, end_.x, bound) || apart(start_.y, end_.y, bound) || apart(start_.z, end_.z, bound);
  }

  void measure() {
    largest_start_ = start_.largest();
    largest_end_ = end_.largest();
  }

  Points at(double t) const {
    return {start_.x + t * (end_.x - start_.x), start_.y + t * (end_.y - start_.y), start_.z + t * (end_.z - start_.z)};
  }

  /// Time until which n certainly keeps them apart from t on: more than 1, if it does to the end; t, if it does not.
  double apartUntil(const Vec3& n, double t) const;

  /// The longest that the other directions keep them apart.
  double apartUntilOthers(const Directions& directions, double t) const {
    return std::max(apartUntil(directions.closest, t), apartUntil(directions.normal, t));
  }

  /// The same for a direction that turns from n at t to m at `last`, as n + (m - n) (time - t) / (last - t); neither
  /// longer than 1 + 4u. More than 1 if it keeps them apart up to `last` = 1; no later than `last` else.
  double apartUntilTurning(const Vec3& n, double t, const Vec3& m, double last) const;

  struct Forecast {
    double
        impact;  ///< time at which the closest points would come as near as min_distance if nothing turned, at most 1
    bool touching;  ///< they are that near but for rounding
  };
  Forecast forecast(const Vec3& n, double t, const Directions& directions) const;

 private:
  static bool apart(const Four& start, const Four& end, double bound) {
    return start.min(end).minCoeff() > bound || start.max(end).maxCoeff() < -bound;
  }

  Points start_;
  Points end_;
  double min_distance_;
  Vec3 largest_start_;  // |coordinate| of any point
  Vec3 largest_end_;
};

// Roundings. n is taken as it is. Computed w are (1 + u) times exact ones, and each product and the two sums of n.w add
// a u at most: |computed n.w - exact| <= 4u/(1 - 4u) S with S = sum_k |n_k| max_i |w_ik|, itself computed with 3u/(1 -
// 3u) at most. So 6u S covers it. |n| is off by 3u, its product by one more: 8u covers those. Products that underflow
// add less than the smallest normal number. The differences q from the bound then have the right sign, and are off by
// 2u of themselves; the time at which (1 - t) q0 + t q1 is zero is q0 / (q0 - q1), a quotient of sums of numbers of one
// sign, off by
// 8u of itself at most.
double MovingHull::apartUntil(const Vec3& n, double t) const {
  constexpr double kSmall = std::numeric_limits<double>::min();
  const Vec3 size = n.cwiseAbs();
  double distance = kSmall;
  if (min_distance_ > 0.0) {
    const double squared = n.squaredNorm();
    if (!(squared > kLeastSquare)) return t;
    distance += min_distance_ * std::sqrt(squared) * (1.0 + 8.0 * kUnit);
  }
  const Four q0 = start_.along(n) - (distance + 6.0 * kUnit * size.dot(largest_start_));
  const Four q1 = end_.along(n) - (distance + 6.0 * kUnit * size.dot(largest_end_));
  if (q0.min(q1).minCoeff() > 0.0) return 2.0;
  double until = 2.0;
  for (int i = 0; i < 4; ++i) {
    if (q0[i] > 0.0 && q1[i] > 0.0) continue;
    if (q0[i] > 0.0) {
      until = std::min(until, q0[i] / (q0[i] - q1[i]) * (1.0 - 16.0 * kUnit));
    } else if (!(q1[i] > 0.0 && q0[i] / (q0[i] - q1[i]) * (1.0 + 16.0 * kUnit) < t)) {
      return t;
    }
  }
  return std::max(until, t);
}

// The projections along the turning direction are polynomials of degree two in time, and the length of that direction
// is no more than the mean of the two, so the polynomials' Bernstein coefficients c0, c1, c2 less min_distance bound
// the gap from below; the convex hull of the three bounds it again (Sederberg and Nishita 1990, Bezier clipping).
// Roundings: as above, and 5u S for an interpolation in time, u S for the mean: 16u S covers them.
double MovingHull::apartUntilTurning(const Vec3& n, double t, const Vec3& m, double last) const {
  const Vec3 largest = largest_start_.cwiseMax(largest_end_);
  const double bound = min_distance_ * (1.0 + 16.0 * kUnit) + std::numeric_limits<double>::min() +
                       16.0 * kUnit * n.cwiseAbs().cwiseMax(m.cwiseAbs()).dot(largest);
  const Four n_start = start_.along(n);
  const Four n_way = end_.along(n) - n_start;
  const Four m_start = start_.along(m);
  const Four m_way = end_.along(m) - m_start;
  const Four c0 = n_start + t * n_way - bound;
  const Four c1 = 0.5 * (n_start + last * n_way + (m_start + t * m_way)) - bound;
  const Four c2 = m_start + last * m_way - bound;
  if (!(c0.minCoeff() > 0.0)) return t;
  if (c1.min(c2).minCoeff() > 0.0) return last < 1.0 ? last : 2.0;
  double share = 1.0;
  for (int i = 0; i < 4; ++i) {
    if (!(c2[i] > 0.0)) share = std::min(share, c0[i] / (c0[i] - c2[i]));
    if (!(c1[i] > 0.0)) {
      share = std::min(share, 0.5 * c0[i] / (c0[i] - c1[i]));
    } else if (!(c2[i] > 0.0)) {
      share = std::min(share, 0.5 + 0.5 * c1[i] / (c1[i] - c2[i]));
    }
  }
  return std::max(t, (t + share * (1.0 - 16.0 * kUnit) * (last - t)) * (1.0 - 4.0 * kUnit));
}

MovingHull::Forecast MovingHull::forecast(const Vec3& n, double t, const Directions& directions) const {
  const Four way = end_.along(n) - start_.along(n);
  const double speed = -(directions.weights * way).sum();
  const double gap = n.dot(directions.closest) - min_distance_;
  const double rounding = 6.0 * kUnit * n.cwiseAbs().dot(largest_start_.cwiseMax(largest_end_));
  return {gap < speed * (1.0 - t) ? std::max(t, t + gap / speed) : 1.0, gap <= kTouching * rounding};
}

/// n without its part along the edge; twice, so that what is left of it is rounding of the result and not of n.
Vec3 across(const Vec3& edge, Vec3 n) {
  const double squared = edge.squaredNorm();
  if (!(squared > 0.0)) return n;
  n -= n.dot(edge) / squared * edge;
  n -= n.dot(edge) / squared * edge;
  return n;
}

Vec3 towards(const Vec3& point, const Vec3& normal) { return point.dot(normal) < 0.0 ? Vec3(-normal) : normal; }

/// p - a, p - b, p - c and once more p - c.
struct VertexTriangle {
  static Directions directions(const Points& hull) {
    const Vec3 a = hull.point(0);
    const Vec3 b = hull.point(1);
    const Vec3 c = hull.point(2);
    const Vec3 weights = closestOnTriangle(Vec3::Zero(), a, b, c).weights;
    Directions out;
    out.closest = weights[0] * a + weights[1] * b + weights[2] * c;
    out.normal = towards(a, (b - a).cross(c - a));
    out.weights << weights[0], weights[1], weights[2], 0.0;
    const bool on_a = weights[0] > 0.0;
    const bool on_b = weights[1] > 0.0;
    const bool on_c = weights[2] > 0.0;
    out.refined = on_a && on_b && on_c ? out.normal
                  : on_a && on_b       ? across(b - a, out.closest)
                  : on_a && on_c       ? across(c - a, out.closest)
                  : on_b && on_c       ? across(c - b, out.closest)
                                       : out.closest;
    return out;
  }
};

/// a - c, a - d, b - c, b - d.
struct EdgeEdge {
  static Directions directions(const Points& hull) {
    const Vec3 ac = hull.point(0);
    const Vec3 ab = hull.point(2) - ac;
    const Vec3 cd = ac - hull.point(1);
    const SegmentsClosest at = closestOnSegments(ac, ac + ab, Vec3::Zero(), cd);
    const bool inside_ab = at.s > 0.0 && at.s < 1.0;
    const bool inside_cd = at.t > 0.0 && at.t < 1.0;
    Directions out;
    out.closest = ac + at.s * ab - at.t * cd;
    out.normal = towards(ac, ab.cross(cd));
    out.weights << (1.0 - at.s) * (1.0 - at.t), (1.0 - at.s) * at.t, at.s * (1.0 - at.t), at.s * at.t;
    out.refined = inside_ab && inside_cd ? out.normal
                  : inside_ab            ? across(ab, out.closest)
                  : inside_cd            ? across(cd, out.closest)
                                         : out.closest;
    return out;
  }
};

/// A direction of unit length within 4u, or zero where its length can't be told.
Vec3 unit(const Vec3& direction) {
  const double squared = direction.squaredNorm();
  return squared > kLeastSquare ? Vec3(direction / std::sqrt(squared)) : Vec3(Vec3::Zero());
}

template <typename Pair>
std::optional<double> timeOfImpact(const Points& start, const Points& end, double min_distance) {
  MovingHull hull(start, end, std::max(min_distance, 0.0));
  if (!hull.finite()) return 0.0;
  if (hull.apartAlongAxes()) return std::nullopt;
  hull.measure();
  double t = 0.0;
  Directions here = Pair::directions(hull.at(t));
  for (int step = 0; step < kMostSteps; ++step) {
    double until = hull.apartUntil(here.refined, t);
    if (until <= t) until = hull.apartUntilOthers(here, t);
    if (until > 1.0) return std::nullopt;
    if (until <= t) return t;
    const Vec3 n = unit(here.refined);
    const auto [impact, touching] = hull.forecast(n, t, here);
    if (touching && std::max(until, impact) - t < kShortStep) {
      until = std::max(until, hull.apartUntilOthers(here, t));
      if (until > 1.0) return std::nullopt;
      if (until - t < kShortStep) return t;
    }
    if (until - t < kGood * (impact - t)) {
      const Directions there = Pair::directions(hull.at(impact));
      Vec3 m = unit(there.refined);
      if (m.dot(n) < 0.0) m = -m;  // of a plane that has gone by
      const double turning = hull.apartUntilTurning(n, t, m, impact);
      if (turning > 1.0) return std::nullopt;
      if (turning >= impact) {
        t = impact;
        here = there;
        continue;
      }
      until = std::max(until, turning);
    }
    t = until;
    here = Pair::directions(hull.at(t));
  }
  return t;
}

}  // namespace

std::optional<double> vertexTriangleTimeOfImpact(const Vec3& p0, const Vec3& a0, const Vec3& b0, const Vec3& c0,
                                                 const Vec3& p1, const Vec3& a1, const Vec3& b1, const Vec3& c1,
                                                 double min_distance) noexcept {
  const auto difference = [](const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    Points points;
    points.set(0, p - a);
    points.set(1, p - b);
    points.set(2, p - c);
    points.set(3, p - c);
    return points;
  };
  return timeOfImpact<VertexTriangle>(difference(p0, a0, b0, c0), difference(p1, a1, b1, c1), min_distance);
}

std::optional<double> edgeEdgeTimeOfImpact(const Vec3& a0, const Vec3& b0, const Vec3& c0, const Vec3& d0,
                                           const Vec3& a1, const Vec3& b1, const Vec3& c1, const Vec3& d1,
                                           double min_distance) noexcept {
  const auto difference = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    Points points;
    points.set(0, a - c);
    points.set(1, a - d);
    points.set(2, b - c);
    points.set(3, b - d);
    return points;
  };
  return timeOfImpact<EdgeEdge>(difference(a0, b0, c0, d0), difference(a1, b1, c1, d1), min_distance);
}

}  // namespace curtain
