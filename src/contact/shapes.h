// SPDX-License-Identifier: BSD-3-Clause
//
// The analytic obstacles: sphere, box, cylinder, capsule and plane. All are convex, so one rule serves them:
// the nearest surface point, unless the node came through the surface on another side. Then it goes back the
// way it came:
//
//        previous o                 a node that passed a plate, or lies in its far half, is not let out below:
//                  \                it is held by the tangent plane of the point where it went in (entry)
//        ===========*===========    entry, normal up
//        ____________\__________
//                     o current
#pragma once

#include "curtain_sim/obstacle_shape.h"

namespace curtain {

/// Where a straight way goes into a solid.
struct SurfaceEntry {
  double way = 0.0;             ///< from the start of the way [m]
  Vec3 point = Vec3::Zero();    ///< on the surface [m]
  Vec3 normal = Vec3::UnitZ();  ///< unit, outward, against the way
};

/// Cosine between the normals of the nearest exit and of the entry, below which they count as different sides.
/// 60 degrees: the faces of a box are always different sides, a sphere is left by the nearest exit unless the
/// node ran a third of the way around it within a single step.
constexpr double kSameSide = 0.5;

/// A convex solid: all that differs between shapes is the nearest point and the entry of a straight way.
class ConvexShape : public ObstacleShape {
 public:
  bool query(const Vec3& previous, const Vec3& current, double reach, SurfacePoint& out) const noexcept final;

  /// Exact signed distance and its gradient at any finite point [m]; where the gradient does not exist (centre,
  /// axis, medial planes) one of the nearest exits, always the same.
  virtual SurfacePoint nearest(const Vec3& point) const noexcept = 0;

 private:
  /// First point where the ray from `start` (not inside) along the unit `direction` goes into the solid.
  virtual bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept = 0;
};

/// Around the origin; radius [m], > 0.
class SphereShape final : public ConvexShape {
 public:
  explicit SphereShape(double radius) : radius_(radius) {}
  SurfacePoint nearest(const Vec3& point) const noexcept override;
  Eigen::AlignedBox3d bounds() const override;
  ShapeTriangles triangles() const override;

 private:
  bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept override;
  double radius_;
};

/// Centred, edges along the axes; size [m], each > 0.
class BoxShape final : public ConvexShape {
 public:
  explicit BoxShape(const Vec3& size) : half_(0.5 * size) {}
  SurfacePoint nearest(const Vec3& point) const noexcept override;
  Eigen::AlignedBox3d bounds() const override;
  ShapeTriangles triangles() const override;

 private:
  bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept override;
  Vec3 half_;
};

/// Along z, centred, flat ends; radius and whole length [m], > 0.
class CylinderShape final : public ConvexShape {
 public:
  CylinderShape(double radius, double length) : radius_(radius), half_(0.5 * length) {}
  SurfacePoint nearest(const Vec3& point) const noexcept override;
  Eigen::AlignedBox3d bounds() const override;
  ShapeTriangles triangles() const override;

 private:
  bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept override;
  double radius_;
  double half_;
};

/// Along z, centred, round ends; radius and length between the caps' centres [m], > 0.
class CapsuleShape final : public ConvexShape {
 public:
  CapsuleShape(double radius, double length) : radius_(radius), half_(0.5 * length) {}
  SurfacePoint nearest(const Vec3& point) const noexcept override;
  Eigen::AlignedBox3d bounds() const override;
  ShapeTriangles triangles() const override;

 private:
  bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept override;
  double radius_;
  double half_;
};

/// The half space z < 0 is solid.
class PlaneShape final : public ConvexShape {
 public:
  SurfacePoint nearest(const Vec3& point) const noexcept override;
  Eigen::AlignedBox3d bounds() const override;
  ShapeTriangles triangles() const override;

 private:
  bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept override;
};

}  // namespace curtain
