// SPDX-License-Identifier: BSD-3-Clause
//
// Springs by which a hand holds nodes that it does not pin: of stiffness k and damping c from places that move with it,
//     f = k (target - x) + c (u - v),
// u being the target's velocity. As the spring of a drag (drag_force.h) it is implicit: target and x are those at the
// end of the substep, x + h v', so that no stiffness is too large for it.
//
// All of a hand's springs together pull with 2 mu N at most, Coulomb's limit for cloth between two pads. Where they
// would pull harder, all are softened by a common factor, and their targets slide after the nodes until the pull is
// that limit: spring and slider in series (Prandtl 1928; Cundall, Strack 1979). Stuck cloth does not creep; sliding
// cloth is pulled with the limit force, whatever hangs on it.
#pragma once

#include <vector>

#include "cloth/cloth.h"

namespace curtain {

/// A node in a hand.
struct HeldNode {
  std::size_t node = 0;
  Vec3 place = Vec3::Zero();     ///< in the gripper's frame [m]
  Vec3 begin = Vec3::Zero();     ///< where that is at the frame's begin [m]
  Vec3 end = Vec3::Zero();       ///< and at its end; it moves there evenly
  Vec3 velocity = Vec3::Zero();  ///< of a pinned node in the last frame, of another before the last substep [m/s]
  Vec3 started = Vec3::Zero();   ///< scratch: velocity before the present substep [m/s]
};

/// The part of a frame that a substep makes.
struct FramePart {
  double end = 1.0;         ///< share of the frame after it
  double h = 0.0;           ///< its length [s]
  double frame_rate = 0.0;  ///< [1/s]
};

class HoldSprings {
 public:
  HoldSprings() = default;
  /// stiffness [N/m] and damping [kg/s] of each; max_force: of all of them [N], may be infinite; mass: of all the
  /// cloth [kg].
  HoldSprings(double stiffness, double damping, double max_force, double mass)
      : stiffness_(stiffness), damping_(damping), max_force_(max_force), mass_(mass) {}

  /// Adds their forces [N] and damping coefficients [kg/s] for a substep from this state.
  void addForces(std::vector<HeldNode>& held, const ClothState& state, const FramePart& part, Field3& force,
                 Field& damping) noexcept;
  /// That substep was accepted, and they pulled with this sum [N].
  void substepAccepted(std::vector<HeldNode>& held, double pull) noexcept;

  double pull() const noexcept { return pull_; }
  void setPull(double pull) noexcept { pull_ = pull; }

  /// Of a spring at the end of that substep [N].
  Vec3 forceAt(const HeldNode& held, const ClothState& state, const FramePart& part) const noexcept {
    return share_ * forceOf(held, state.position.at(held.node), state.velocity.at(held.node), part);
  }
  /// Share of its elongation [m] that each spring keeps at the end of the substep: 1, or less where they slide.
  double kept(const std::vector<HeldNode>& held, const Field3& position, const FramePart& part) const noexcept;

  static Vec3 targetOf(const HeldNode& held, double share) noexcept {
    return held.begin + share * (held.end - held.begin);
  }

 private:
  Vec3 forceOf(const HeldNode& held, const Vec3& position, const Vec3& velocity, const FramePart& part) const noexcept {
    const Vec3 moves = part.frame_rate * (held.end - held.begin);
    return stiffness_ * (targetOf(held, part.end) - position) + damping_ * (moves - velocity);
  }

  double shareOf(const std::vector<HeldNode>& held, const ClothState& state, const FramePart& part) const noexcept;

  double stiffness_ = 0.0, damping_ = 0.0, max_force_ = 0.0, mass_ = 0.0;
  double pull_ = 0.0;   // in the last accepted substep [N]
  double share_ = 1.0;  // of their stiffness, in the last substep
};

}  // namespace curtain
