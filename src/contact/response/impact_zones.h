// SPDX-License-Identifier: BSD-3-Clause
//
// Impact zones: groups of nodes that would cross each other and move as one rigid body instead (Provot 1997, Collision
// and self-collision handling in cloth model dedicated to design garments; Harmon et al. 2008). A zone preserves
// momentum and angular momentum, and within an affine motion no two parts meet.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

class ImpactZones {
 public:
  /// pattern must outlive this.
  explicit ImpactZones(const ClothPattern& pattern);

  void clear() noexcept;
  bool any() const noexcept { return !members_.empty(); }
  /// Merges the zones of two nodes.
  void join(std::size_t a, std::size_t b) noexcept;
  /// Gives every zone a rigid motion, x_end = x_start + T + theta x (x_start - centre), with the momentum and angular
  /// momentum of its nodes. A zone with pins follows these.
  void makeRigid(const Field3& start, Field3& end) noexcept;
  /// Stops all nodes of zones except pins.
  void stop(const Field3& start, Field3& end) const noexcept;

 private:
  struct Body {
    double mass = 0.0;
    double pins = 0.0;  // number of pinned nodes
    Vec3 pin_move = Vec3::Zero();
    Vec3 centre = Vec3::Zero(), move = Vec3::Zero(), spin = Vec3::Zero(), turn = Vec3::Zero();
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  };
  static constexpr std::uint32_t kAlone = ~0u;

  std::uint32_t find(std::uint32_t node) noexcept;
  std::uint32_t enter(std::size_t node) noexcept;
  Body& bodyOf(std::uint32_t node) noexcept { return bodies_[body_[find(node)]]; }

  const ClothPattern& pattern_;
  std::vector<std::uint32_t> parent_;   // by node
  std::vector<std::uint32_t> members_;  // nodes of all zones, in the order of joining
  std::vector<std::uint32_t> body_;     // by root node
  std::vector<Body> bodies_;
};

}  // namespace curtain
