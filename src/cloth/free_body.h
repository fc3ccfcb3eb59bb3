// SPDX-License-Identifier: BSD-3-Clause
//
// Momentum and angular momentum of a cloth, and the rigid motion that restores them. Internal forces change neither,
// but computed ones may act slightly off the line between their points (directions that follow the solve, friction
// across a gap); the error is taken out by a rigid motion of the whole cloth.
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

/// Velocity field of a rigid body: velocity(x) = drift + turn x (x - centre).
struct RigidMotion {
  Vec3 centre = Vec3::Zero();
  Vec3 drift = Vec3::Zero();
  Vec3 turn = Vec3::Zero();
  Vec3 at(const Vec3& x) const noexcept { return drift + turn.cross(x - centre); }
  /// Rigid displacement over a time [s]: x -> displacement + rotation (x - centre) + centre.
  struct Displacement {
    Vec3 centre, shift;
    Eigen::Matrix3d rotation;
    Vec3 operator()(const Vec3& x) const noexcept { return centre + shift + rotation * (x - centre); }
  };
  Displacement over(double time) const noexcept;
};

/// The rigid motion of nodes at `position` that has this momentum. Nodes on one line do not turn about it.
RigidMotion rigidMotion(const ClothPattern& pattern, const Field3& position, const Momentum& momentum) noexcept;

/// turn with inertia turn = spin, without rotation about axes of zero inertia.
Vec3 turnOf(const Eigen::Matrix3d& inertia, const Vec3& spin) noexcept;

}  // namespace curtain
