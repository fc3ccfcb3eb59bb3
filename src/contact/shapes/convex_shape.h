// SPDX-License-Identifier: BSD-3-Clause
//
// Obstacles that are convex solids known by their distance. A new one is a file like sphere.h: it says the nearest
// point of its surface, its support function and its triangles for drawing; all that contact asks follows from these.
//
// A node that came through the surface goes back the way it came:
//
//        previous o                 a node that passed a plate, or lies in its far half, is not let out below:
//                  \                it is held by the tangent plane of the point where it went in (entry)
//        ===========*===========    entry, normal up
//        ____________\__________
//                     o current
//
// The signed distance to a convex solid is a convex function. So Newton's method along a straight way finds the entry
// from outside without passing it, and the distance takes one smallest value on a cloth edge or triangle
// (tangent_search.h).
#pragma once

#include <array>
#include <optional>

#include "contact/shapes/contact_shape.h"

namespace curtain {

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

/// Largest difference of ElementPoint's distance to the smallest one and to the lower bound, as a share of the
/// element's longest edge; roundings of the coordinates come on top.
constexpr double kElementAccuracy = 1e-7;

/// Cosine between the normals of the nearest exit and of the entry, below which they count as different sides.
/// 60 degrees: the faces of a box are always different sides, a sphere is left by the nearest exit unless the
/// node ran a third of the way around it within a single step.
constexpr double kSameSide = 0.5;

/// A convex solid.
class ConvexShape : public ContactShape {
 public:
  bool query(const Vec3& previous, const Vec3& current, double reach, SurfacePoint& out) const noexcept final;
  const ConvexShape* convex() const noexcept final { return this; }
  /// From the support function.
  Eigen::AlignedBox3d bounds() const override;

  /// Exact signed distance and its gradient at any finite point [m]; where the gradient does not exist (centre,
  /// axis, medial planes) one of the nearest exits: of two opposite ones that on the side of `beside` [m], a place near
  /// by; where it tells no side, or is not given, always the same.
  virtual SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept = 0;
  SurfacePoint nearest(const Vec3& point) const noexcept { return nearest(point, Vec3::Zero()); }

  /// How far the solid reaches along a unit direction from the origin, its support function [m]; infinite: without end.
  virtual double support(const Vec3& direction) const noexcept = 0;

  /// Smallest radius its surface bends by [m]; 0: it has edges; infinite: it is flat. Cloth whose nodes are clear of a
  /// surface that bends less than the cloth is clear of it, too.
  virtual double smoothRadius() const noexcept { return 0.0; }

  /// The point of a triangle (an edge) nearest to the solid or deepest in it, to kElementAccuracy; where many are, one
  /// of them. false: the whole of it is further out than `reach` [m] (any number, infinity too), for certain. Corners
  /// in the shape's frame [m], finite, below 1e150; elements without area or length are fine. Allocates nothing.
  bool nearestOnTriangle(const std::array<Vec3, 3>& corners, double reach, ElementPoint& out) const noexcept;
  bool nearestOnEdge(const std::array<Vec3, 2>& ends, double reach, ElementPoint& out) const noexcept;

  /// When a triangle (an edge) whose corners go straight and evenly from `start` (time 0) to `end` (time 1), as seen
  /// from the solid, first comes nearer than `min_distance` [m] (negative: deeper). Conservative: never later than the
  /// truth; none only if it certainly never does. Early by the way that covers about kElementAccuracy, and where it
  /// would take more than kMostAdvances looks to tell. An element that starts at the distance itself has time 0.
  std::optional<double> timeOfImpact(const std::array<Vec3, 3>& start, const std::array<Vec3, 3>& end,
                                     double min_distance) const noexcept;
  std::optional<double> timeOfImpact(const std::array<Vec3, 2>& start, const std::array<Vec3, 2>& end,
                                     double min_distance) const noexcept;

  /// Looks at a moving element before it counts as touching.
  static constexpr int kMostAdvances = 40;

 protected:
  /// size: of the solid's coordinates [m], to allow for their rounding.
  explicit ConvexShape(double size) : size_(size) {}
  double size() const noexcept { return size_; }

 private:
  /// Where a straight way goes into the solid.
  struct Entry {
    Vec3 point = Vec3::Zero();    // on the surface [m]
    Vec3 normal = Vec3::UnitZ();  // unit, outward, against the way
  };
  bool enter(const Vec3& start, const Vec3& direction, double length, Entry& entry) const noexcept;
  template <std::size_t N>
  bool findMinimum(const std::array<Vec3, N>& corners, double reach, ElementMinimum& out) const noexcept;
  template <std::size_t N>
  std::optional<double> advance(const std::array<Vec3, N>& start, const std::array<Vec3, N>& end,
                                double min_distance) const noexcept;
  /// By tangents; a shape with a closed form has its own. Once the lower bound is beyond reach they may stop.
  virtual void minimise(const std::array<Vec3, 3>& corners, double reach, ElementMinimum& out) const noexcept;
  virtual void minimise(const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) const noexcept;

  double size_;
};

}  // namespace curtain
