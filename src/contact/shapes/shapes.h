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
//
// The signed distance to a convex solid is a convex function, so there is one value it takes at the nearest (or deepest)
// point of a cloth edge or triangle: convex_elements.cpp finds it, and when a moving one first comes near.
#pragma once

#include <array>
#include <optional>

#include "contact/shapes/obstacle_features.h"
#include "curtain_sim/obstacle_shape.h"

namespace curtain {

/// Where a straight way goes into a solid.
struct SurfaceEntry {
  double way = 0.0;             ///< from the start of the way [m]
  Vec3 point = Vec3::Zero();    ///< on the surface [m]
  Vec3 normal = Vec3::UnitZ();  ///< unit, outward, against the way
};

/// The point of an edge or a triangle that is nearest to a solid, or deepest in it.
struct ElementPoint {
  std::array<double, 3> weights{};  ///< of its corners, each >= 0, together 1; the third of an edge is 0
  SurfacePoint surface;             ///< there
  double lower_bound = 0.0;         ///< no point of the element has a smaller distance, for certain [m]
};

/// The smallest distance of an element, with a plane that shows it: everywhere in space
/// distance(x) >= support_bound + support . x - (the smallest of support . corner).
struct ElementMinimum {
  ElementPoint point;
  Vec3 support = Vec3::Zero();  ///< length 1 at most
  double support_bound = 0.0;   ///< [m]
};

/// Largest difference of ElementPoint's distance to the smallest one and to the lower bound, as a share of the element's
/// longest edge; roundings of the coordinates come on top.
constexpr double kElementAccuracy = 1e-7;

/// Cosine between the normals of the nearest exit and of the entry, below which they count as different sides.
/// 60 degrees: the faces of a box are always different sides, a sphere is left by the nearest exit unless the
/// node ran a third of the way around it within a single step.
constexpr double kSameSide = 0.5;

/// A convex solid: all that differs between shapes is the nearest point and the entry of a straight way.
class ConvexShape : public ObstacleShape {
 public:
  bool query(const Vec3& previous, const Vec3& current, double reach, SurfacePoint& out) const noexcept final;

  /// Exact signed distance and its gradient at any finite point [m]; where the gradient does not exist (centre,
  /// axis, medial planes) one of the nearest exits: of two opposite ones that on the side of `beside` [m], a place near
  /// by; where it tells no side, or is not given, always the same.
  virtual SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept = 0;
  SurfacePoint nearest(const Vec3& point) const noexcept { return nearest(point, Vec3::Zero()); }

  /// How far the solid reaches along a unit direction from the origin, its support function [m]; infinite: without end.
  virtual double support(const Vec3& direction) const noexcept = 0;

  const ConvexShape* convex() const noexcept final { return this; }

  /// The point of a triangle (an edge) nearest to the solid or deepest in it, to kElementAccuracy; where many are, one of
  /// them. false: the whole of it is further out than `reach` [m] (any number, infinity too), for certain. Corners in the
  /// shape's frame [m], finite, below 1e150; elements without area or length are fine. Allocates nothing.
  bool nearestOnTriangle(const std::array<Vec3, 3>& corners, double reach, ElementPoint& out) const noexcept;
  bool nearestOnEdge(const std::array<Vec3, 2>& ends, double reach, ElementPoint& out) const noexcept;

  /// When a triangle (an edge) whose corners go straight and evenly from `start` (time 0) to `end` (time 1), as seen from
  /// the solid, first comes nearer than `min_distance` [m] (negative: deeper). Conservative: never later than the truth;
  /// none only if it certainly never does. Early by the way that covers about kElementAccuracy, and where it would take
  /// more than kMostAdvances looks to tell. An element that starts at the distance itself has time 0.
  std::optional<double> timeOfImpact(const std::array<Vec3, 3>& start, const std::array<Vec3, 3>& end,
                                     double min_distance) const noexcept;
  std::optional<double> timeOfImpact(const std::array<Vec3, 2>& start, const std::array<Vec3, 2>& end,
                                     double min_distance) const noexcept;

  /// Looks at a moving element before it counts as touching.
  static constexpr int kMostAdvances = 40;

 private:
  template <std::size_t N>
  bool findMinimum(const std::array<Vec3, N>& corners, double reach, ElementMinimum& out) const noexcept;
  /// Once the lower bound is beyond reach they may stop.
  virtual void minimise(const std::array<Vec3, 3>& corners, double reach, ElementMinimum& out) const noexcept = 0;
  virtual void minimise(const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) const noexcept = 0;
  /// First point where the ray from `start` (not inside) along the unit `direction` goes into the solid.
  virtual bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept = 0;
};

/// Around the origin; radius [m], > 0.
class SphereShape final : public ConvexShape {
 public:
  explicit SphereShape(double radius) : radius_(radius) {}
  using ConvexShape::nearest;
  SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept override;
  double support(const Vec3& direction) const noexcept override;
  Eigen::AlignedBox3d bounds() const override;
  ShapeTriangles triangles() const override;

 private:
  bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept override;
  void minimise(const std::array<Vec3, 3>& corners, double reach, ElementMinimum& out) const noexcept override;
  void minimise(const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) const noexcept override;
  double radius_;
};

/// Centred, edges along the axes; size [m], each > 0.
class BoxShape final : public ConvexShape {
 public:
  explicit BoxShape(const Vec3& size);
  using ConvexShape::nearest;
  SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept override;
  double support(const Vec3& direction) const noexcept override;
  Eigen::AlignedBox3d bounds() const override;
  ShapeTriangles triangles() const override;
  const ObstacleFeatures* features() const noexcept override { return &features_; }

 private:
  bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept override;
  void minimise(const std::array<Vec3, 3>& corners, double reach, ElementMinimum& out) const noexcept override;
  void minimise(const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) const noexcept override;
  MeshTopology topology() const;
  Vec3 half_;
  ObstacleFeatures features_;
};

/// Along z, centred, flat ends; radius and whole length [m], > 0.
class CylinderShape final : public ConvexShape {
 public:
  CylinderShape(double radius, double length) : radius_(radius), half_(0.5 * length) {}
  using ConvexShape::nearest;
  SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept override;
  double support(const Vec3& direction) const noexcept override;
  Eigen::AlignedBox3d bounds() const override;
  ShapeTriangles triangles() const override;

 private:
  bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept override;
  void minimise(const std::array<Vec3, 3>& corners, double reach, ElementMinimum& out) const noexcept override;
  void minimise(const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) const noexcept override;
  double radius_;
  double half_;
};

/// Along z, centred, round ends; radius and length between the caps' centres [m], > 0.
class CapsuleShape final : public ConvexShape {
 public:
  CapsuleShape(double radius, double length) : radius_(radius), half_(0.5 * length) {}
  using ConvexShape::nearest;
  SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept override;
  double support(const Vec3& direction) const noexcept override;
  Eigen::AlignedBox3d bounds() const override;
  ShapeTriangles triangles() const override;

 private:
  bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept override;
  void minimise(const std::array<Vec3, 3>& corners, double reach, ElementMinimum& out) const noexcept override;
  void minimise(const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) const noexcept override;
  double radius_;
  double half_;
};

/// The half space z < 0 is solid.
class PlaneShape final : public ConvexShape {
 public:
  using ConvexShape::nearest;
  SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept override;
  double support(const Vec3& direction) const noexcept override;
  Eigen::AlignedBox3d bounds() const override;
  ShapeTriangles triangles() const override;

 private:
  bool enter(const Vec3& start, const Vec3& direction, SurfaceEntry& entry) const noexcept override;
  void minimise(const std::array<Vec3, 3>& corners, double reach, ElementMinimum& out) const noexcept override;
  void minimise(const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) const noexcept override;
};

}  // namespace curtain
