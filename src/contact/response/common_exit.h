// SPDX-License-Identifier: BSD-3-Clause
//
// The side on which what is inside a convex obstacle (which has appeared there, or jumped) comes out together. Each
// node's own nearest exit may draw the cloth apart: of a box in its middle some leave upwards and some sideways, and
// links that hold keep them all inside.
//
//            ___________          Cloth that passes through a box has two ways out, across itself. Along
//           |           |         itself there is none, however near that side is: the cloth beyond the far
//      o----|--o--o--o--|----o    side would be drawn through. It is one only where the cloth ends inside.
//           |___________|
#pragma once

#include <array>
#include <vector>

#include "contact/broad_phase/vicinity.h"
#include "contact/shapes/convex_shape.h"

namespace curtain {

/// A face that starts inside an obstacle with none of its nodes, and its deepest point.
struct PiercedFace {
  MeshTriangle node;
  ElementPoint deepest;
};

class CommonExit {
 public:
  /// Of the nodes and faces that start inside. grid, near and faces must outlive this.
  CommonExit(const Grid& grid, const Vicinity& near, const std::vector<PiercedFace>& faces) noexcept;

  /// The surface that a point leaves by which starts inside: its own, or the common one where it would leave on another
  /// side.
  SurfacePoint lead(const Vec3& from, const SurfacePoint& own) const noexcept;

 private:
  static constexpr std::size_t kMost = 16;  // sides to choose among; round shapes have as many as there are nodes

  /// Something that starts inside.
  struct Part {
    Vec3 at;                              // [m]
    Vec3 across;                          // normal of the cloth there, of any length
    std::array<std::uint32_t, 4> joined;  // nodes that links join to it
    std::size_t joined_count;
  };

  bool isInside(std::size_t node) const noexcept { return near_.distanceOf(node) < 0.0; }
  Part partOf(std::uint32_t node) const noexcept;
  Part partOf(const PiercedFace& face) const noexcept;
  template <typename F>
  void forEachPart(const F& f) const noexcept;
  void addCandidate(const Vec3& normal) noexcept;
  Vec3 acrossCloth() const noexcept;
  bool drawsThrough(const Vec3& normal) const noexcept;
  double depthAlong(const Vec3& normal) const noexcept;
  double wayOut(const Vec3& from, const Vec3& direction) const noexcept;

  const Grid& grid_;
  const Vicinity& near_;
  const std::vector<PiercedFace>& faces_;
  const ConvexShape* shape_;
  std::array<Vec3, kMost> candidates_;
  std::size_t count_ = 0;
  bool any_ = false;
  Vec3 normal_ = Vec3::UnitZ();
};

}  // namespace curtain
