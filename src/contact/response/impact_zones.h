// SPDX-License-Identifier: BSD-3-Clause
//
// Collision zones: groups of nodes that would go through each other and are moved as one body instead (Provot 1997,
// Collision and self-collision handling in cloth model dedicated to design garments; Harmon et al. 2008). A zone keeps
// its nodes' momentum and angular momentum, and an even affine motion brings no two parts of it together.
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
  /// Both nodes belong to one zone.
  void join(std::size_t a, std::size_t b) noexcept;
  /// Gives the nodes of every zone the motion of a body: x_end = x_start + T + theta x (x_start - centre), with their
  /// momentum and angular momentum. A zone with pinned nodes goes with them.
  void makeRigid(const Field3& start, Field3& end) noexcept;
  /// Or no motion but that of their pins.
  void stop(const Field3& start, Field3& end) const noexcept;

 private:
  struct Body {
    double mass = 0.0;
    double pins = 0.0;  // nodes that go their own way
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
  std::vector<std::uint32_t> members_;  // nodes of any zone, in the order they came
  std::vector<std::uint32_t> body_;     // by root node
  std::vector<Body> bodies_;
};

}  // namespace curtain
