// SPDX-License-Identifier: BSD-3-Clause
#include "sensing/solid_rays.h"

#include <cmath>

#include "scene/infinity.h"

namespace curtain {
namespace {

// Where the ray goes in and out; never: in > out.
struct Passage {
  double in = kInfinity, out = -kInfinity;
  Vec3 in_normal = Vec3::Zero(), out_normal = Vec3::Zero();

  bool empty() const { return !(in <= out); }
};

Passage common(const Passage& a, const Passage& b) {
  Passage both = a;
  if (b.in > a.in) both.in = b.in, both.in_normal = b.in_normal;
  if (b.out < a.out) both.out = b.out, both.out_normal = b.out_normal;
  return both;
}

// For parts whose union is convex.
Passage joined(const Passage& a, const Passage& b) {
  if (a.empty()) return b;
  if (b.empty()) return a;
  Passage all = a;
  if (b.in < a.in) all.in = b.in, all.in_normal = b.in_normal;
  if (b.out > a.out) all.out = b.out, all.out_normal = b.out_normal;
  return all;
}

// Between two planes across an axis.
Passage throughSlab(const Vec3& origin, const Vec3& direction, int axis, double half) {
  const double at = origin[axis], speed = direction[axis];
  Passage passage;
  if (speed == 0.0) {
    if (std::abs(at) <= half) passage.in = -kInfinity, passage.out = kInfinity;
    return passage;
  }
  const double side = speed > 0.0 ? 1.0 : -1.0;
  passage.in = (-side * half - at) / speed;
  passage.out = (side * half - at) / speed;
  passage.in_normal = -side * Vec3::Unit(axis);
  passage.out_normal = side * Vec3::Unit(axis);
  return passage;
}

// Through a ball about the frame's origin; with a mask (1, 1, 0) a tube along z. From the ray's point nearest to the
// centre, so that large distances cancel nothing.
Passage throughBall(const Vec3& origin, const Vec3& direction, double radius, const Vec3& mask) {
  const Vec3 o = origin.cwiseProduct(mask), d = direction.cwiseProduct(mask);
  const double speed_squared = d.squaredNorm();
  Passage passage;
  if (speed_squared == 0.0) {
    if (o.norm() <= radius) passage.in = -kInfinity, passage.out = kInfinity;
    return passage;
  }
  const double middle = -o.dot(d) / speed_squared;
  const double depth_squared = radius * radius - (o + middle * d).squaredNorm();
  if (!(depth_squared >= 0.0)) return passage;
  const double half = std::sqrt(depth_squared / speed_squared);
  passage.in = middle - half;
  passage.out = middle + half;
  passage.in_normal = (o + passage.in * d) / radius;
  passage.out_normal = (o + passage.out * d) / radius;
  return passage;
}

// The half space below z = 0.
Passage throughPlane(const Vec3& origin, const Vec3& direction) {
  Passage passage{-kInfinity, kInfinity, Vec3::UnitZ(), Vec3::UnitZ()};
  if (direction.z() == 0.0) return origin.z() <= 0.0 ? passage : Passage();
  (direction.z() < 0.0 ? passage.in : passage.out) = -origin.z() / direction.z();
  return passage;
}

Passage through(const ObstacleParams& shape, const Vec3& origin, const Vec3& direction) {
  const Vec3 tube(1.0, 1.0, 0.0);
  const double half = 0.5 * shape.length;
  switch (shape.shape) {
    case ShapeKind::kSphere:
      return throughBall(origin, direction, shape.radius, Vec3::Ones());
    case ShapeKind::kBox: {
      Passage passage = throughSlab(origin, direction, 0, 0.5 * shape.size.x());
      for (const int axis : {1, 2})
        passage = common(passage, throughSlab(origin, direction, axis, 0.5 * shape.size[axis]));
      return passage;
    }
    case ShapeKind::kCylinder:
    case ShapeKind::kCapsule: {
      const Passage cylinder =
          common(throughBall(origin, direction, shape.radius, tube), throughSlab(origin, direction, 2, half));
      if (shape.shape == ShapeKind::kCylinder) return cylinder;
      const Vec3 up = half * Vec3::UnitZ();
      return joined(joined(cylinder, throughBall(origin - up, direction, shape.radius, Vec3::Ones())),
                    throughBall(origin + up, direction, shape.radius, Vec3::Ones()));
    }
    case ShapeKind::kPlane:
      return throughPlane(origin, direction);
    case ShapeKind::kMesh:
      break;
  }
  return {};
}

}  // namespace

std::optional<SolidHit> firstHit(const ObstacleParams& shape, const Vec3& origin, const Vec3& direction,
                                 double nearest) {
  const Passage passage = through(shape, origin, direction);
  if (passage.empty()) return std::nullopt;
  if (passage.in > nearest) return SolidHit{passage.in, passage.in_normal};
  if (passage.out > nearest && passage.out < kInfinity) return SolidHit{passage.out, passage.out_normal};
  return std::nullopt;
}

}  // namespace curtain
