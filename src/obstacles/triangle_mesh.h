// SPDX-License-Identifier: BSD-3-Clause
//
// An obstacle made of triangles: a watertight mesh is a solid with exact signed distance, any other a thin shell whose
// free side is where the node came from.
#pragma once

#include <memory>

#include "obstacles/contact_shape.h"
#include "obstacles/distance_grid.h"
#include "obstacles/obstacle_features.h"
#include "obstacles/triangle_mesh_topology.h"
#include "obstacles/triangle_mesh_tree.h"

namespace curtain {

class TriangleMeshShape final : public ContactShape {
 public:
  /// Corners finite [m], equal corners shared, at least one triangle of nonzero area.
  explicit TriangleMeshShape(ShapeTriangles mesh);

  bool query(const Vec3& previous, const Vec3& current, double reach, SurfacePoint& out) const noexcept override;
  /// The same answer, faster if `near` was found for a nearby point; refreshes it otherwise, with a margin for motion
  /// of `room` [m].
  bool query(const Vec3& previous, const Vec3& current, double reach, double room, NearTriangles& near,
             SurfacePoint& out) const noexcept;
  Eigen::AlignedBox3d bounds() const override { return tree_.bounds(); }
  ShapeTriangles triangles() const override { return topology_.mesh; }

  const ObstacleFeatures* features() const noexcept override { return &features_; }

  /// Every edge has two triangles of the same orientation, and there is an inside.
  bool watertight() const { return topology_.watertight; }

 private:
  template <typename Search>
  bool querySolid(const Vec3& previous, const Vec3& current, double reach, Search&& search,
                  SurfacePoint& out) const noexcept;
  template <typename Search>
  bool queryShell(const Vec3& previous, const Vec3& current, double reach, Search&& search,
                  SurfacePoint& out) const noexcept;
  template <typename Search>
  bool queryBy(const Vec3& previous, const Vec3& current, double reach, Search&& search,
               SurfacePoint& out) const noexcept {
    return topology_.watertight ? querySolid(previous, current, reach, search, out)
                                : queryShell(previous, current, reach, search, out);
  }

  /// Plane of the triangle through which the path previous -> current enters; false: it enters nowhere.
  bool entry(const Vec3& previous, const Vec3& current, SurfacePoint& out) const noexcept;
  const Vec3& pseudonormal(const NearestTriangle& nearest) const noexcept;
  /// Signed distance and gradient at `point`, given its nearest triangle; outside of an open mesh on both sides.
  SurfacePoint surfacePoint(const Vec3& point, const NearestTriangle& nearest) const noexcept;
  double gridDistance(const Vec3& point, double bound) const;

  MeshTopology topology_;
  ObstacleFeatures features_;
  TriangleMeshTree tree_;
  double tiny_ = 0.0;  // distance below which directions to the surface are rounding [m]
  std::unique_ptr<const DistanceGrid> grid_;
};

}  // namespace curtain
