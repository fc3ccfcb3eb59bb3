// SPDX-License-Identifier: BSD-3-Clause
//
// Momentum and angular momentum of all nodes of a cloth, and the rigid motion that gives back what is missing of them.
// Forces between parts of the cloth change neither; where a computed one acts a little off the line between its points
// (directions that follow the solve, friction across a gap) the whole cloth is turned by what that amounts to.
#pragma once

#include <Eigen/Geometry>

#include "cloth/cloth.h"

namespace curtain {

struct Momentum {
  Vec3 linear = Vec3::Zero();   ///< [kg m/s]
  Vec3 angular = Vec3::Zero();  ///< about the world's origin [kg m^2/s]
};

/// Of nodes at `position` [m] with `velocity` [m/s].
Momentum momentumOf(const ClothPattern& pattern, const Field3& position, const Field3& velocity) noexcept;

/// An even motion: velocity(x) = drift + turn x (x - centre).
struct RigidMotion {
  Vec3 centre = Vec3::Zero();
  Vec3 drift = Vec3::Zero();
  Vec3 turn = Vec3::Zero();
  Vec3 at(const Vec3& x) const noexcept { return drift + turn.cross(x - centre); }
  /// How it moves points in a time [s], all distances kept: x -> displacement + rotation (x - centre) + centre.
  struct Displacement {
    Vec3 centre, shift;
    Eigen::Matrix3d rotation;
    Vec3 operator()(const Vec3& x) const noexcept { return centre + shift + rotation * (x - centre); }
  };
  Displacement over(double time) const noexcept;
};

/// The rigid motion of nodes at `position` that has this momentum. Nodes on one line do not turn about it.
RigidMotion rigidMotion(const ClothPattern& pattern, const Field3& position, const Momentum& momentum) noexcept;

/// turn with inertia turn = spin; nothing turns about an axis without inertia.
Vec3 turnOf(const Eigen::Matrix3d& inertia, const Vec3& spin) noexcept;

}  // namespace curtain
