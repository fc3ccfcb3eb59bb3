// SPDX-License-Identifier: BSD-3-Clause
//
// Distances and entries of the analytic obstacles. Vectors are scaled before they are squared, so that no
// finite input over- or underflows to NaN; entries are measured from the foot of the perpendicular on the way,
// which keeps them exact however far away the way starts.
#include "contact/shapes/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace curtain {
namespace {

/// Beyond this way [m] in one step there is no crossing to speak of, and its square would overflow.
constexpr double kLongestWay = 1e150;

/// Unit vector along v and its length; the fallback for v = 0.
template <typename Vector>
Vector unitOr(const Vector& v, const Vector& fallback, double& length) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) {
    length = 0.0;
    return fallback;
  }
  const Vector scaled = v / largest;
  const double norm = scaled.norm();
  length = largest * norm;
  return scaled / norm;
}

/// A way through a solid shorter than this share of its size touches an edge and does not enter: a start on an edge
/// rounds to either side of it. Roundings are 1e-15 of the size; 1e-12 m is nothing to a cloth.
constexpr double kTouch = 1e-12;

double signOf(double x) { return x < 0.0 ? -1.0 : 1.0; }

/// The side x is on; when it is on neither, the one that `beside` is on.
double sideOf(double x, double beside) { return signOf(x != 0.0 ? x : beside); }

/// Unit vector along v and its length; for v = 0 along `beside`, if that has a direction.
template <typename Vector>
Vector unitBeside(const Vector& v, const Vector& beside, const Vector& fallback, double& length) {
  const Vector unit = unitOr<Vector>(v, fallback, length);
  if (length > 0.0) return unit;
  double far = 0.0;
  return unitOr<Vector>(beside, fallback, far);
}

/// Where the line through `start` goes into a ball (a disc) around the origin; `way` < 0: behind the start.
template <typename Vector>
bool enterBall(const Vector& start, const Vector& direction, double radius, double& way, Vector& point) {
  const double along = start.dot(direction);
  const Vector foot = start - along * direction;
  const double square = (radius - foot.norm()) * (radius + foot.norm());  // half chord squared
  if (!(square > 0.0)) {
    return false;
  }
  const double half_chord = std::sqrt(square);
  way = -along - half_chord;
  point = foot - half_chord * direction;
  return true;
}

/// Way along which a line stays within |z| < half; false: never.
bool slabInterval(double start, double direction, double half, double& in, double& out) {
  if (direction == 0.0) {
    in = -std::numeric_limits<double>::infinity();
    out = -in;
    return std::abs(start) < half;
  }
  in = (-signOf(direction) * half - start) / direction;
  out = (signOf(direction) * half - start) / direction;
  return true;
}

}  // namespace

bool ConvexShape::query(const Vec3& previous, const Vec3& current, double reach, SurfacePoint& out) const noexcept {
  const SurfacePoint surface = nearest(current, previous);
  const Vec3 move = current - previous;
  // Distance grows by at most the way: who is further out than that touched nothing.
  if (surface.distance <= move.lpNorm<1>()) {
    double length = 0.0;
    const Vec3 direction = unitOr<Vec3>(move, Vec3::UnitZ(), length);
    SurfaceEntry entry;
    if (length > 0.0 && length < kLongestWay && nearest(previous).distance >= 0.0 &&
        enter(previous, direction, entry) && entry.way <= length) {
      const double depth = entry.normal.dot(current - entry.point);
      const bool passed = surface.distance >= 0.0 || surface.normal.dot(entry.normal) < kSameSide;
      if (depth < 0.0 && passed) {
        out.distance = depth;
        out.normal = entry.normal;
        return true;
      }
    }
  }
  if (surface.distance > reach) {
    return false;
  }
  out = surface;
  return true;
}

// ---- sphere --------------------------------------------------------------------------------------------------

double SphereShape::support(const Vec3& direction) const noexcept { return radius_ * direction.norm(); }

SurfacePoint SphereShape::nearest(const Vec3& point, const Vec3& beside) const noexcept {
  SurfacePoint surface;
  double length = 0.0;
  surface.normal = unitBeside<Vec3>(point, beside, Vec3::UnitZ(), length);
  surface.distance = length - radius_;
  return surface;
}

bool SphereShape::enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept {
  if (!(start.dot(direction) < 0.0) || !enterBall<Vec3>(start, direction, radius_, entry.way, entry.point)) {
    return false;  // the ball lies behind, or aside
  }
  entry.normal = entry.point.normalized();
  return true;
}

Eigen::AlignedBox3d SphereShape::bounds() const {
  return Eigen::AlignedBox3d(Vec3::Constant(-radius_), Vec3::Constant(radius_));
}

// ---- box -----------------------------------------------------------------------------------------------------

BoxShape::BoxShape(const Vec3& size) : half_(0.5 * size), features_(topology(), FlatEdges::kDrop) {}

double BoxShape::support(const Vec3& direction) const noexcept { return half_.dot(direction.cwiseAbs()); }

SurfacePoint BoxShape::nearest(const Vec3& point, const Vec3& beside) const noexcept {
  const Vec3 beyond = point.cwiseAbs() - half_;
  SurfacePoint surface;
  int axis = 0;
  surface.distance = beyond.maxCoeff(&axis);
  if (surface.distance <= 0.0) {
    surface.normal = sideOf(point[axis], beside[axis]) * Vec3::Unit(axis);
    return surface;
  }
  surface.normal = unitOr<Vec3>(beyond.cwiseMax(0.0), Vec3::UnitZ(), surface.distance);
  for (int i = 0; i < 3; ++i) {
    surface.normal[i] *= signOf(point[i]);
  }
  return surface;
}

bool BoxShape::enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept {
  double last_in = -std::numeric_limits<double>::infinity();
  double first_out = std::numeric_limits<double>::infinity();
  int axis = 0;
  for (int i = 0; i < 3; ++i) {
    double in = 0.0;
    double out = 0.0;
    if (!slabInterval(start[i], direction[i], half_[i], in, out)) {
      return false;
    }
    if (in > last_in) {
      last_in = in;
      axis = i;
    }
    first_out = std::min(first_out, out);
  }
  if (!(last_in >= 0.0 && first_out - last_in > kTouch * half_.maxCoeff())) {
    return false;
  }
  entry.way = last_in;
  entry.point = start + last_in * direction;
  entry.point[axis] = -signOf(direction[axis]) * half_[axis];
  entry.normal = -signOf(direction[axis]) * Vec3::Unit(axis);
  return true;
}

Eigen::AlignedBox3d BoxShape::bounds() const { return Eigen::AlignedBox3d(-half_, half_); }

// ---- cylinder ------------------------------------------------------------------------------------------------

double CylinderShape::support(const Vec3& direction) const noexcept { return radius_ * direction.head<2>().norm() + half_ * std::abs(direction.z()); }

SurfacePoint CylinderShape::nearest(const Vec3& point, const Vec3& beside) const noexcept {
  double radial = 0.0;
  const Eigen::Vector2d outward =
      unitBeside<Eigen::Vector2d>(point.head<2>(), beside.head<2>(), Eigen::Vector2d::UnitX(), radial);
  const Eigen::Vector2d beyond(radial - radius_, std::abs(point.z()) - half_);  // of the side, of the end
  SurfacePoint surface;
  Eigen::Vector2d profile = beyond[0] >= beyond[1] ? Eigen::Vector2d::UnitX() : Eigen::Vector2d::UnitY();
  surface.distance = beyond.maxCoeff();
  if (surface.distance > 0.0) {
    profile = unitOr<Eigen::Vector2d>(beyond.cwiseMax(0.0), profile, surface.distance);
  }
  surface.normal << profile[0] * outward, profile[1] * sideOf(point.z(), beside.z());
  return surface;
}

bool CylinderShape::enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept {
  double in = 0.0;
  double out = 0.0;
  if (!slabInterval(start.z(), direction.z(), half_, in, out)) {
    return false;
  }
  entry.normal = -signOf(direction.z()) * Vec3::UnitZ();
  const double slope = direction.head<2>().norm();
  if (slope > 0.0) {
    double way = 0.0;
    Eigen::Vector2d point;
    const Eigen::Vector2d across = direction.head<2>() / slope;
    if (!enterBall<Eigen::Vector2d>(start.head<2>(), across, radius_, way, point)) {
      return false;
    }
    out = std::min(out, (way - 2.0 * point.dot(across)) / slope);  // the other end of the chord
    if (way / slope > in) {
      in = way / slope;
      entry.normal << point.normalized(), 0.0;
    }
  } else if (!(start.head<2>().norm() < radius_)) {
    return false;
  }
  // From outside, the solid lies wholly ahead or wholly behind; its middle tells which, whatever the rounding of a
  // start on the surface.
  if (!(out - in > kTouch * (radius_ + half_) && in + out > 0.0)) {
    return false;
  }
  entry.way = std::max(in, 0.0);
  entry.point = start + entry.way * direction;
  return true;
}

Eigen::AlignedBox3d CylinderShape::bounds() const {
  const Vec3 corner(radius_, radius_, half_);
  return Eigen::AlignedBox3d(-corner, corner);
}

// ---- capsule -------------------------------------------------------------------------------------------------

double CapsuleShape::support(const Vec3& direction) const noexcept { return radius_ * direction.norm() + half_ * std::abs(direction.z()); }

SurfacePoint CapsuleShape::nearest(const Vec3& point, const Vec3& beside) const noexcept {
  const Vec3 foot(0.0, 0.0, std::clamp(point.z(), -half_, half_));
  SurfacePoint surface;
  double length = 0.0;
  const Vec3 across(beside.x(), beside.y(), 0.0);
  surface.normal = unitBeside<Vec3>(point - foot, across, Vec3::UnitX(), length);
  surface.distance = length - radius_;
  return surface;
}

bool CapsuleShape::enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept {
  // The capsule is the union of its side and two balls: the first entry into any of them.
  entry.way = std::numeric_limits<double>::infinity();
  for (const double end : {-half_, half_}) {
    const Vec3 centre(0.0, 0.0, end);
    double way = 0.0;
    Vec3 point;
    const bool ahead = (start - centre).dot(direction) < 0.0;
    if (ahead && enterBall<Vec3>(start - centre, direction, radius_, way, point) && way < entry.way) {
      entry.way = way;
      entry.point = point + centre;
      entry.normal = point.normalized();
    }
  }
  const double slope = direction.head<2>().norm();
  if (slope > 0.0) {
    double way = 0.0;
    Eigen::Vector2d point;
    const Eigen::Vector2d across = direction.head<2>() / slope;
    // Off the ends a start may be within the radius: then the side lies behind it.
    if (enterBall<Eigen::Vector2d>(start.head<2>(), across, radius_, way, point) && way >= -kTouch * radius_ &&
        way / slope < entry.way) {
      const double z = start.z() + way / slope * direction.z();
      if (std::abs(z) <= half_) {
        entry.way = way / slope;
        entry.point << point, z;
        entry.normal << point.normalized(), 0.0;
      }
    }
  }
  return entry.way < std::numeric_limits<double>::infinity();
}

Eigen::AlignedBox3d CapsuleShape::bounds() const {
  const Vec3 corner(radius_, radius_, half_ + radius_);
  return Eigen::AlignedBox3d(-corner, corner);
}

// ---- plane ---------------------------------------------------------------------------------------------------

double PlaneShape::support(const Vec3& direction) const noexcept {
  const bool up = direction.z() > 0.0 && direction.head<2>().isZero(0.0);
  return up ? 0.0 : std::numeric_limits<double>::infinity();
}

SurfacePoint PlaneShape::nearest(const Vec3& point, const Vec3&) const noexcept {
  SurfacePoint surface;
  surface.distance = point.z();
  return surface;
}

bool PlaneShape::enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept {
  if (!(direction.z() < 0.0)) {
    return false;
  }
  entry.way = start.z() / -direction.z();
  entry.point = start + entry.way * direction;
  entry.point.z() = 0.0;
  entry.normal = Vec3::UnitZ();
  return true;
}

Eigen::AlignedBox3d PlaneShape::bounds() const {
  const double infinity = std::numeric_limits<double>::infinity();
  return Eigen::AlignedBox3d(Vec3::Constant(-infinity), Vec3(infinity, infinity, 0.0));
}

}  // namespace curtain
