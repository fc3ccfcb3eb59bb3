// SPDX-License-Identifier: BSD-3-Clause
//
// Both queries are one: the Minkowski difference of the two elements, the convex hull of the corners' differences w_i
// (three of a vertex and a triangle, four of two edges), against the origin. Each w_i moves straight, so along any
// fixed direction n its projection is linear in time, and n separates the elements exactly while all n.w_i >
// min_distance |n|. This is conservative advancement (Mirtich 1996) with that bound in place of one on speeds:
//
//    n_0 = direction of the closest points at t = 0, separates until t_1
//    n_1 = direction of the closest points at t_1,   separates until t_2 > t_1 …
//
// It ends when a direction separates beyond 1 (no impact) or none certainly separates any longer (impact). For elements
// that turn, a direction that turns with them, from the closest points now to those at the predicted impact, lasts
// longer: near an impact that makes it Newton's method. Only the times need to be certain, not the choice of
// directions.
#include "curtain_sim/ccd.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/narrow_phase/closest_points.h"

namespace curtain {
namespace {

/// Unit roundoff u: an operation is off by at most u times its result.
constexpr double kRoundoff = 0.5 * std::numeric_limits<double>::epsilon();

/// Steps before an impact is reported. A dozen suffice unless the elements slide along at a distance of rounding.
constexpr int kMaxSteps = 100;

/// Squared lengths below this may have lost digits to underflow.
constexpr double kMinSquare = 1e-280;

/// A fixed direction that separates for this share of the time to the predicted impact is good enough.
constexpr double kGood = 0.95;

/// A gap below this multiple of its rounding error counts as touching: further steps would gain no more than that.
constexpr double kTouching = 4.0;

/// Shortest useful step once touching [share of the motion].
constexpr double kShortStep = 1e-9;

/// Sum of all coordinates beyond which products of four might overflow [m].
constexpr double kLargest = 1e75;

using Four = Eigen::Array4d;

/// Four points, one a lane.
struct Points {
  Four x, y, z;
  Vec3 point(int i) const { return {x[i], y[i], z[i]}; }
  static Points of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return {{a.x(), b.x(), c.x(), d.x()}, {a.y(), b.y(), c.y(), d.y()}, {a.z(), b.z(), c.z(), d.z()}};
  }
  Four along(const Vec3& n) const { return x * n.x() + y * n.y() + z * n.z(); }
  Vec3 largest() const { return {x.abs().maxCoeff(), y.abs().maxCoeff(), z.abs().maxCoeff()}; }
  double sum() const { return (x.abs() + y.abs() + z.abs()).sum(); }
};

/// Directions that may separate a hull from the origin, the best first.
struct Directions {
  Vec3 refined;  ///< of the closest points, orthogonalised against their edges: accurate down to distances of rounding
  Vec3 closest;  ///< of the closest points, as computed
  Vec3 normal;   ///< normal of the elements, towards the hull
  Four weights;  ///< barycentric, of the closest point
};

/// Hull of the corners' differences at the start and the end.
class MovingHull {
 public:
  MovingHull(const Points& start, const Points& end, double min_distance)
      : start_(start), end_(end), min_distance_(min_distance) {}

  bool finite() const { return start_.sum() + end_.sum() + min_distance_ < kLargest; }

  /// Whether a coordinate axis separates them throughout. A difference of two numbers has the exact sign and is off by
  /// u of itself.
  bool apartAlongAxes() const {
    const double bound = min_distance_ * (1.0 + 4.0 * kRoundoff);
    return apart(start_.x, end_.x, bound) || apart(start_.y, end_.y, bound) || apart(start_.z, end_.z, bound);
  }

  void measure() {
    largest_start_ = start_.largest();
    largest_end_ = end_.largest();
  }

  Points at(double t) const {
    return {start_.x + t * (end_.x - start_.x), start_.y + t * (end_.y - start_.y), start_.z + t * (end_.z - start_.z)};
  }

  /// Time until which n certainly separates them, starting at t: more than 1 if to the end; t if not at all.
  double apartUntil(const Vec3& n, double t) const;

  /// The same for the better of the other directions.
  double apartUntilOthers(const Directions& directions, double t) const {
    return std::max(apartUntil(directions.closest, t), apartUntil(directions.normal, t));
  }

  /// The same for a direction that turns from n at t to m at `last`, n + (m - n) (time - t) / (last - t); neither
  /// longer than 1 + 4u. More than 1 if it separates them to `last` = 1; otherwise at most `last`.
  double apartUntilTurning(const Vec3& n, double t, const Vec3& m, double last) const;

  struct Forecast {
    double
        impact;  ///< time at which the closest points would come as near as min_distance if nothing turned, at most 1
    bool touching;  ///< that near already, within rounding
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

// Rounding. n counts as exact. Computed w are (1 + u) times the exact ones, and each product and the two sums of n.w
// add u at most: |computed n.w - exact| <= 4u/(1 - 4u) S with S = sum_k |n_k| max_i |w_ik|, itself computed with
// relative error 3u/(1 - 3u). So 6u S covers it. |n| is off by 3u, its product by one more: 8u covers those. Products
// that underflow add less than the smallest normal number. The differences q from the bound then have the right sign
// and a relative error of 2u. The time at which (1 - t) q0 + t q1 vanishes is q0 / (q0 - q1), a quotient of sums of
// numbers of one sign, with a relative error of at most 8u.
double MovingHull::apartUntil(const Vec3& n, double t) const {
  constexpr double kSmall = std::numeric_limits<double>::min();
  const Vec3 size = n.cwiseAbs();
  double distance = kSmall;
  if (min_distance_ > 0.0) {
    const double squared = n.squaredNorm();
    if (!(squared > kMinSquare)) return t;
    distance += min_distance_ * std::sqrt(squared) * (1.0 + 8.0 * kRoundoff);
  }
  const Four q0 = start_.along(n) - (distance + 6.0 * kRoundoff * size.dot(largest_start_));
  const Four q1 = end_.along(n) - (distance + 6.0 * kRoundoff * size.dot(largest_end_));
  if (q0.min(q1).minCoeff() > 0.0) return 2.0;
  double until = 2.0;
  for (int i = 0; i < 4; ++i) {
    if (q0[i] > 0.0 && q1[i] > 0.0) continue;
    if (q0[i] > 0.0) {
      until = std::min(until, q0[i] / (q0[i] - q1[i]) * (1.0 - 16.0 * kRoundoff));
    } else if (!(q1[i] > 0.0 && q0[i] / (q0[i] - q1[i]) * (1.0 + 16.0 * kRoundoff) < t)) {
      return t;
    }
  }
  return std::max(until, t);
}

// Projections along the turning direction are quadratic in time, and its length is at most the mean of the two
// lengths. So the Bernstein coefficients c0, c1, c2 of these polynomials less min_distance bound the gap from below,
// and so does their convex hull (Sederberg and Nishita 1990, Bezier clipping). Rounding as above, plus 5u S for an
// interpolation in time and u S for the mean: 16u S covers all.
double MovingHull::apartUntilTurning(const Vec3& n, double t, const Vec3& m, double last) const {
  const Vec3 largest = largest_start_.cwiseMax(largest_end_);
  const double bound = min_distance_ * (1.0 + 16.0 * kRoundoff) + std::numeric_limits<double>::min() +
                       16.0 * kRoundoff * n.cwiseAbs().cwiseMax(m.cwiseAbs()).dot(largest);
  const Four n_start = start_.along(n);
  const Four n_motion = end_.along(n) - n_start;
  const Four m_start = start_.along(m);
  const Four m_motion = end_.along(m) - m_start;
  const Four c0 = n_start + t * n_motion - bound;
  const Four c1 = 0.5 * (n_start + last * n_motion + (m_start + t * m_motion)) - bound;
  const Four c2 = m_start + last * m_motion - bound;
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
  return std::max(t, (t + share * (1.0 - 16.0 * kRoundoff) * (last - t)) * (1.0 - 4.0 * kRoundoff));
}

MovingHull::Forecast MovingHull::forecast(const Vec3& n, double t, const Directions& directions) const {
  const Four motion = end_.along(n) - start_.along(n);
  const double speed = -(directions.weights * motion).sum();
  const double gap = n.dot(directions.closest) - min_distance_;
  const double rounding = 6.0 * kRoundoff * n.cwiseAbs().dot(largest_start_.cwiseMax(largest_end_));
  return {gap < speed * (1.0 - t) ? std::max(t, t + gap / speed) : 1.0, gap <= kTouching * rounding};
}

/// n made orthogonal to the edge; twice, so that what remains of the parallel part is rounding of the result.
Vec3 across(const Vec3& edge, Vec3 n) {
  const double squared = edge.squaredNorm();
  if (!(squared > 0.0)) return n;
  n -= n.dot(edge) / squared * edge;
  n -= n.dot(edge) / squared * edge;
  return n;
}

Vec3 towards(const Vec3& point, const Vec3& normal) { return point.dot(normal) < 0.0 ? Vec3(-normal) : normal; }

/// p - a, p - b, p - c and once more p - c.
struct VertexTriangleMotion {
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
struct EdgeEdgeMotion {
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

/// Unit length within 4u; zero where the length underflows.
Vec3 unit(const Vec3& direction) {
  const double squared = direction.squaredNorm();
  return squared > kMinSquare ? Vec3(direction / std::sqrt(squared)) : Vec3(Vec3::Zero());
}

template <typename Pair>
std::optional<double> timeOfImpact(const Points& start, const Points& end, double min_distance) {
  MovingHull hull(start, end, std::max(min_distance, 0.0));
  if (!hull.finite()) return 0.0;
  if (hull.apartAlongAxes()) return std::nullopt;
  hull.measure();
  double t = 0.0;
  Directions here = Pair::directions(hull.at(t));
  for (int step = 0; step < kMaxSteps; ++step) {
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
      if (m.dot(n) < 0.0) m = -m;  // the plane has passed the origin
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
    return Points::of(p - a, p - b, p - c, p - c);
  };
  return timeOfImpact<VertexTriangleMotion>(difference(p0, a0, b0, c0), difference(p1, a1, b1, c1), min_distance);
}

std::optional<double> edgeEdgeTimeOfImpact(const Vec3& a0, const Vec3& b0, const Vec3& c0, const Vec3& d0,
                                           const Vec3& a1, const Vec3& b1, const Vec3& c1, const Vec3& d1,
                                           double min_distance) noexcept {
  const auto difference = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return Points::of(a - c, a - d, b - c, b - d);
  };
  return timeOfImpact<EdgeEdgeMotion>(difference(a0, b0, c0, d0), difference(a1, b1, c1, d1), min_distance);
}

}  // namespace curtain
