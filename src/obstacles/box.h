// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdlib>

#include "obstacles/convex_shape.h"
#include "obstacles/directions.h"
#include "obstacles/obstacle_features.h"

namespace curtain {

/// Centred, edges along the axes; size [m], each > 0.
class BoxShape final : public ConvexShape {
 public:
  explicit BoxShape(const Vec3& size)
      : ConvexShape(0.5 * size.maxCoeff()), half_(0.5 * size), features_(topology(), FlatEdges::kDrop) {}
  using ConvexShape::nearest;

  SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept override {
    const Vec3 beyond = point.cwiseAbs() - half_;
    SurfacePoint surface;
    int axis = 0;
    surface.distance = beyond.maxCoeff(&axis);
    if (surface.distance <= 0.0) {
      surface.normal = sideOf(point[axis], beside[axis]) * Vec3::Unit(axis);
      return surface;
    }
    surface.normal = unitOr<Vec3>(beyond.cwiseMax(0.0), Vec3::UnitZ(), surface.distance);
    for (int i = 0; i < 3; ++i) surface.normal[i] *= signOf(point[i]);
    return surface;
  }
  double support(const Vec3& direction) const noexcept override { return half_.dot(direction.cwiseAbs()); }
  ShapeTriangles triangles() const override {
    ShapeTriangles shape;
    for (int i = 0; i < 8; ++i) {
      shape.corners.emplace_back(i & 1 ? half_.x() : -half_.x(), i & 2 ? half_.y() : -half_.y(),
                                 i & 4 ? half_.z() : -half_.z());
    }
    shape.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                       {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return shape;
  }
  const ObstacleFeatures* features() const noexcept override { return &features_; }

 private:
  /// Built directly: analysis of the mesh would find fewer faces of a box thinner than rounding.
  MeshTopology topology() const {
    MeshTopology topology;
    topology.mesh = triangles();
    topology.watertight = true;
    for (const int face : {-3, 3, -2, 2, -1, 1}) {  // axis and side, in the order of triangles()
      const Vec3 normal = (face < 0 ? -1.0 : 1.0) * Vec3::Unit(std::abs(face) - 1);
      topology.face_normals.insert(topology.face_normals.end(), 2, normal);
      topology.edge_normals.insert(topology.edge_normals.end(), 2, {normal, normal, normal});
    }
    for (const Vec3& corner : topology.mesh.corners) {
      topology.corner_normals.push_back(corner.cwiseSign().normalized());
    }
    return topology;
  }

  Vec3 half_;
  ObstacleFeatures features_;
};

}  // namespace curtain
