// SPDX-License-Identifier: BSD-3-Clause
//
// Common depenetration direction of everything inside a convex obstacle that appeared in the cloth or jumped. With each
// node's own nearest exit parts may leave on different sides (in the middle of a box, some upwards and some sideways),
// and links would then hold the cloth inside.
//
//             ___________          Cloth that passes through a box has two exits, both across itself. Sideways there
//            |           |         is none, however near that side is: the cloth beyond the far side would be pulled
//       o----|--o--o--o--|----o    through. Sideways is an exit only where the cloth ends inside.
//            |___________|
#pragma once

#include <array>
#include <vector>

#include "contact/broad_phase/obstacle_candidates.h"
#include "obstacles/convex_shape.h"

namespace curtain {

/// A face that starts inside an obstacle while none of its nodes does, and its deepest point.
struct PenetratingFace {
  MeshTriangle node;
  ElementPoint deepest;
};

class ExitDirection {
 public:
  /// From the nodes and faces that start inside. grid, candidates and faces must outlive this.
  ExitDirection(const Grid& grid, const ObstacleCandidates& candidates,
                const std::vector<PenetratingFace>& faces) noexcept;

  /// Surface through which a point that starts inside leaves: its nearest one, or the common one if that is another
  /// side.
  SurfacePoint exitSurface(const Vec3& from, const SurfacePoint& own) const noexcept;

 private:
  static constexpr std::size_t kMost = 16;  // directions compared; round shapes have as many as nodes inside

  /// A node or a face that starts inside.
  struct Part {
    Vec3 at;                              // [m]
    Vec3 across;                          // normal of the cloth there, not unit
    std::array<std::uint32_t, 4> joined;  // neighbour nodes
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
