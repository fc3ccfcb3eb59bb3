// SPDX-License-Identifier: BSD-3-Clause
//
// The side on which what is inside a convex obstacle (which has appeared there, or jumped) comes out together. Each
// node's own nearest exit may draw the cloth apart: of a box in its middle some leave upwards and some sideways, and
// links that hold keep them all inside.
//
//            ___________          Cloth that passes through a box has two ways out, across itself. Along
//           |           |         itself there is none, however candidates that side is: the cloth beyond the far
//      o----|--o--o--o--|----o    side would be drawn through. It is one only where the cloth ends inside.
//           |___________|
#pragma once

#include <array>
#include <vector>

#include "contact/broad_phase/obstacle_candidates.h"
#include "contact/shapes/convex_shape.h"

namespace curtain {

/// A face that starts inside an obstacle with none of its nodes, and its deepest point.
struct PenetratingFace {
  MeshTriangle node;
  ElementPoint deepest;
};

class ExitDirection {
 public:
  /// Of the nodes and faces that start inside. grid, near and faces must outlive this.
  ExitDirection(const Grid& grid, const ObstacleCandidates& candidates,
                const std::vector<PenetratingFace>& faces) noexcept;

  /// The surface that a point leaves by which starts inside: its own, or the common one where it would leave on another
  /// side.
  SurfacePoint exitSurface(const Vec3& from, const SurfacePoint& own) const noexcept;

 private:
  static constexpr std::size_t kMost = 16;  // sides to choose among; round shapes have as many as there are nodes

  /// Something that starts inside.
  struct Part {
    Vec3 at;                              // [m]
    Vec3 across;                          // normal of the cloth there, of any length
    std::array<std::uint32_t, 4> joined;  // nodes that links join to it
    std::size_t joined_count;
  };

  bool isInside(std::size_t node) const noexcept { return candidates_.distanceOf(node) < 0.0; }
  Part partOf(std::uint32_t node) const noexcept;
  Part partOf(const PenetratingFace& face) const noexcept;
  template <typename F>
  void forEachPart(const F& f) const noexcept;
  void addDirection(const Vec3& normal) noexcept;
  Vec3 clothNormal() const noexcept;
  bool pullsClothThrough(const Vec3& normal) const noexcept;
  double depthAlong(const Vec3& normal) const noexcept;
  double exitDistance(const Vec3& from, const Vec3& direction) const noexcept;

  const Grid& grid_;
  const ObstacleCandidates& candidates_;
  const std::vector<PenetratingFace>& faces_;
  const ConvexShape* shape_;
  std::array<Vec3, kMost> directions_;
  std::size_t count_ = 0;
  bool any_ = false;
  Vec3 normal_ = Vec3::UnitZ();
};

}  // namespace curtain
