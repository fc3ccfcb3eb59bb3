// SPDX-License-Identifier: BSD-3-Clause
#include "obstacles/corner_normals.h"

#include <cmath>

namespace curtain {
namespace {

const double kCosCrease = std::cos(0.7);  // 40 degrees: wider than between facets of our round shapes

// Twice the triangle's area long.
Vec3 areaNormal(const ShapeTriangles& shape, const Eigen::Vector3i& triangle) {
  const auto at = [&](int corner) { return shape.corners[static_cast<std::size_t>(triangle[corner])]; };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

}  // namespace

std::vector<Vec3> cornerNormals(const ShapeTriangles& shape) {
  std::vector<Vec3> faces;
  std::vector<std::vector<std::size_t>> faces_at(shape.corners.size());
  for (const Eigen::Vector3i& triangle : shape.triangles) {
    for (int k = 0; k < 3; ++k) faces_at[static_cast<std::size_t>(triangle[k])].push_back(faces.size());
    faces.push_back(areaNormal(shape, triangle));
  }
  std::vector<Vec3> normals;
  normals.reserve(3 * faces.size());
  for (std::size_t own = 0; own < faces.size(); ++own) {
    for (int k = 0; k < 3; ++k) {
      Vec3 sum = Vec3::Zero();
      for (const std::size_t other : faces_at[static_cast<std::size_t>(shape.triangles[own][k])]) {
        const double cosine = faces[own].dot(faces[other]);
        if (cosine >= kCosCrease * faces[own].norm() * faces[other].norm()) sum += faces[other];
      }
      normals.push_back(sum.normalized());  // a triangle without area, which has no normal, keeps zero
    }
  }
  return normals;
}

}  // namespace curtain
