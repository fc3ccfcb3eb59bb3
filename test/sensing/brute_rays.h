// SPDX-License-Identifier: BSD-3-Clause
//
// The first thing a ray meets, found without any of the code under test: every triangle of the cloth and of mesh
// obstacles, and, for solids, steps of the distance to their surface (Hart, Sphere Tracing, 1996). In double, in the
// world's frame.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "obstacles/contact_shape.h"
#include "sensing/moment.h"
#include "sensing/ray_caster.h"

namespace curtain_test {

using curtain::Vec3;

struct BruteHit {
  double distance = std::numeric_limits<double>::infinity();
  std::uint16_t label = curtain::RayHit::kBackground;
};

/// Parameter of the intersection with a triangle (Moeller, Trumbore 1997); infinite: none.
inline double meetTriangle(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const Vec3 one = b - a, other = c - a, across = direction.cross(other);
  const double volume = one.dot(across);
  if (volume == 0.0) return kNone;
  const Vec3 from = origin - a, turned = from.cross(one);
  const double u = from.dot(across) / volume, v = direction.dot(turned) / volume;
  if (u < 0.0 || v < 0.0 || u + v > 1.0) return kNone;
  return other.dot(turned) / volume;
}

/// Parameter at which a ray of unit direction comes within 1e-9 m of a solid, from outside.
inline double meetSolid(const curtain::ObstacleShape& shape, const Vec3& origin, const Vec3& direction, double nearest,
                        double farthest) {
  double at = nearest;
  for (int step = 0; step < 100000 && at < farthest; ++step) {
    const Vec3 point = origin + at * direction;
    curtain::SurfacePoint surface;
    if (!shape.query(point, point, 100.0, surface)) break;
    if (surface.distance < 1e-9) return at;
    at += surface.distance;
  }
  return std::numeric_limits<double>::infinity();
}

/// The first hit within a range. direction: unit; the origin is in no solid.
inline BruteHit firstThing(const curtain::Simulator& simulator, const curtain::Moment& moment, const Vec3& origin,
                           const Vec3& direction, double nearest, double farthest) {
  BruteHit first;
  const auto note = [&](double distance, std::size_t label) {
    if (distance > nearest && distance <= farthest && distance < first.distance)
      first = {distance, static_cast<std::uint16_t>(label)};
  };
  const std::vector<Vec3>& points = moment.mesh.positions;
  for (const auto& t : simulator.fineMeshTopology().triangles)
    note(meetTriangle(origin, direction, points[t[0]], points[t[1]], points[t[2]]), 1);
  for (std::size_t i = 0; i < moment.obstacles.size(); ++i) {
    if (moment.present[i] == 0) continue;
    const curtain::Pose& pose = moment.obstacles[i];
    const Vec3 o = pose.orientation.conjugate() * (origin - pose.position);
    const Vec3 d = pose.orientation.conjugate() * direction;
    const curtain::ObstacleShape& shape = simulator.obstacleShape(static_cast<int>(i));
    if (simulator.scene().obstacles[i].shape == curtain::ShapeKind::kMesh) {
      const curtain::ShapeTriangles mesh = shape.triangles();
      for (const auto& t : mesh.triangles) {
        const auto corner = [&](int k) -> const Vec3& { return mesh.corners[static_cast<std::size_t>(t[k])]; };
        note(meetTriangle(o, d, corner(0), corner(1), corner(2)), 2 + i);
      }
    } else {
      note(meetSolid(shape, o, d, nearest, farthest), 2 + i);
    }
  }
  return first;
}

}  // namespace curtain_test
