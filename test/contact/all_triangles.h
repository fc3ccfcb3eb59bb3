// SPDX-License-Identifier: BSD-3-Clause
//
// What meshes are held against: a search through all of their triangles.
#pragma once

#include <algorithm>
#include <cmath>

#include "obstacles/triangle_mesh.h"
#include "scene/infinity.h"
#include "testing.h"

namespace curtain_test {

using curtain::ShapeTriangles;
using curtain::Vec3;

using curtain::kInfinity;

// Coordinates here are below 4 m: a handful of roundings of 4.4e-16 each stay below this [m].
constexpr double kRounding = 1e-14;

/// Square of n x n cells, side 1 around the origin, in z = height.
inline ShapeTriangles sheet(int n, double height) {
  ShapeTriangles mesh;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      mesh.corners.emplace_back(static_cast<double>(j) / n - 0.5, static_cast<double>(i) / n - 0.5, height);
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j;
      mesh.triangles.emplace_back(a, a + 1, a + n + 2);
      mesh.triangles.emplace_back(a, a + n + 2, a + n + 1);
    }
  }
  return mesh;
}

inline const Vec3& cornerOf(const ShapeTriangles& mesh, std::size_t t, int i) {
  return mesh.corners[static_cast<std::size_t>(mesh.triangles[t][i])];
}

/// Distance to a triangle by an independent formula: plane distance if the foot is inside, else nearest of the edges.
inline double triangleDistance(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const Vec3 foot = p - normal.dot(p - a) * normal;
  const auto inner = [&](const Vec3& u, const Vec3& v) { return normal.dot((v - u).cross(foot - u)) >= 0.0; };
  if (inner(a, b) && inner(b, c) && inner(c, a)) {
    return std::abs(normal.dot(p - a));
  }
  const auto segment = [&p](const Vec3& u, const Vec3& v) {
    const double t = std::min(1.0, std::max(0.0, (p - u).dot(v - u) / (v - u).squaredNorm()));
    return (p - (u + t * (v - u))).norm();
  };
  return std::min({segment(a, b), segment(b, c), segment(c, a)});
}

inline double bruteDistance(const ShapeTriangles& mesh, const Vec3& p) {
  double nearest = kInfinity;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    nearest = std::min(nearest, triangleDistance(p, cornerOf(mesh, t, 0), cornerOf(mesh, t, 1), cornerOf(mesh, t, 2)));
  }
  return nearest;
}

/// Turns around the point that the mesh makes (1 inside, 0 outside), by solid angles (Van Oosterom, Strackee 1983).
inline double windingNumber(const ShapeTriangles& mesh, const Vec3& p) {
  double angle = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = cornerOf(mesh, t, 0) - p;
    const Vec3 b = cornerOf(mesh, t, 1) - p;
    const Vec3 c = cornerOf(mesh, t, 2) - p;
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                     b.dot(c) * a.norm() + c.dot(a) * b.norm());
  }
  return angle / (4.0 * kPi);
}

}  // namespace curtain_test
