// SPDX-License-Identifier: BSD-3-Clause
//
// Convex solids with an analytic distance. A new one is a file like sphere.h with the nearest point of its surface, its
// support function and its triangles for drawing; everything contact needs follows from these.
//
// A node that came through the surface is returned to where it entered:
//
//        previous o                 a node that passed a plate, or is in its far half, must not leave at the far side:
//                  \                it is held by the tangent plane of the point of entry
//        ===========*===========    entry, normal up
//        ____________\__________
//                     o current
//
// The signed distance to a convex solid is a convex function. So Newton's method along a straight path finds the entry
// from outside without passing it, and the distance has one minimum on a cloth edge or triangle (cutting_planes.h).
#pragma once

#include <array>
#include <optional>

#include "obstacles/contact_shape.h"

namespace curtain {

/// The point of an edge or a triangle that is nearest to a solid, or deepest in it.
struct ElementPoint {
  std::array<double, 3> weights{};  ///< of the corners, each >= 0, sum 1; the third of an edge is 0
  SurfacePoint surface;             ///< there
  double lower_bound = 0.0;         ///< lower bound of the distance over the element [m]
};

/// The minimum of the distance over an element, with the plane that bounds it: everywhere in space distance(x) >=
/// support_bound + support . x - (the smallest of support . corner).
struct ElementMinimum {
  ElementPoint point;
  Vec3 support = Vec3::Zero();  ///< length 1 at most
  double support_bound = 0.0;   ///< [m]
};

/// Accuracy of the minimum: largest difference between ElementPoint's distance, the true minimum and the lower bound,
/// as a share of the element's longest edge; rounding of the coordinates comes on top.
constexpr double kElementAccuracy = 1e-7;

/// Cosine between the normals of the nearest exit and of the entry below which they are different sides. 60 degrees:
/// faces of a box always are; on a sphere only if the node moved around a third of it within one step.
constexpr double kSameSide = 0.5;

/// A convex solid.
class ConvexShape : public ContactShape {
 public:
  bool query(const Vec3& previous, const Vec3& current, double reach, SurfacePoint& out) const noexcept final;
  const ConvexShape* convex() const noexcept final { return this; }
  /// From the support function.
  Eigen::AlignedBox3d bounds() const override;

  /// Exact signed distance and gradient at any finite point [m]. Where the gradient is undefined (centre, axis, medial
  /// planes) one of the nearest exits: of two opposite ones that on the side of `beside` [m], a nearby point; if that
  /// is undecided or not given, always the same.
  virtual SurfacePoint nearest(const Vec3& point, const Vec3& beside) const noexcept = 0;
  SurfacePoint nearest(const Vec3& point) const noexcept { return nearest(point, Vec3::Zero()); }

  /// Support function: largest projection of the solid on a unit direction [m]; may be infinite.
  virtual double support(const Vec3& direction) const noexcept = 0;

  /// Smallest radius of curvature of the surface [m]; 0: it has edges; infinite: flat. Between nodes that are clear of
  /// a surface flatter than the cloth, the cloth is clear, too.
  virtual double smoothRadius() const noexcept { return 0.0; }

  /// Point of a triangle (edge) nearest to the solid or deepest in it, to kElementAccuracy; one of them where several
  /// are. false: all of it is certainly further than `reach` [m] (any number, infinity too). Corners in the shape's
  /// frame [m], finite, below 1e150; elements of zero area or length are allowed. Allocates nothing.
  bool nearestOnTriangle(const std::array<Vec3, 3>& corners, double reach, ElementPoint& out) const noexcept;
  bool nearestOnEdge(const std::array<Vec3, 2>& ends, double reach, ElementPoint& out) const noexcept;

  /// Time in [0, 1] at which a triangle (edge) whose corners move straight from `start` to `end`, in the shape's
  /// frame, first comes nearer than `min_distance` [m] (negative: deeper). Conservative: never late, and none only if
  /// it certainly never does. Early by at most the time for about kElementAccuracy, or more when kMaxAdvances steps
  /// do not suffice. 0 for an element that starts at that distance.
  std::optional<double> timeOfImpact(const std::array<Vec3, 3>& start, const std::array<Vec3, 3>& end,
                                     double min_distance) const noexcept;
  std::optional<double> timeOfImpact(const std::array<Vec3, 2>& start, const std::array<Vec3, 2>& end,
                                     double min_distance) const noexcept;

  /// Steps of conservative advancement before an element counts as touching.
  static constexpr int kMaxAdvances = 40;

 protected:
  /// size: largest coordinate of the solid [m], for rounding.
  explicit ConvexShape(double size) : size_(size) {}
  double size() const noexcept { return size_; }

 private:
  /// Where a straight path enters the solid.
  struct Entry {
    Vec3 point = Vec3::Zero();    // on the surface [m]
    Vec3 normal = Vec3::UnitZ();  // unit, outward
  };
  bool enter(const Vec3& start, const Vec3& direction, double length, Entry& entry) const noexcept;
  template <std::size_t N>
  bool findMinimum(const std::array<Vec3, N>& corners, double reach, ElementMinimum& out) const noexcept;
  template <std::size_t N>
  std::optional<double> advance(const std::array<Vec3, N>& start, const std::array<Vec3, N>& end,
                                double min_distance) const noexcept;
  /// By cutting planes; shapes with a closed form override it. May stop once the lower bound exceeds reach.
  virtual void minimise(const std::array<Vec3, 3>& corners, double reach, ElementMinimum& out) const noexcept;
  virtual void minimise(const std::array<Vec3, 2>& ends, double reach, ElementMinimum& out) const noexcept;

  double size_;
};

}  // namespace curtain
