// SPDX-License-Identifier: BSD-3-Clause
//
// How far a line turns at a node, with a sign. With the directions t and t' of its links (in rest lengths) the sine of
// the turn is n . (t x t'), and n is the direction of the line across, between the node's neighbours on it: it follows
// the cloth, so that a couple about it and what it exerts across leave no net force and no net torque.
#pragma once

#include "cloth/cloth.h"

namespace curtain {

/// A node where a line turns.
struct TurningJoint {
  std::size_t before, node, after;  ///< along the line
  std::size_t left, right;          ///< across; at a border, or a slit, the node itself
  double per_before, per_after;     ///< 1 / rest length [1/m]
  double shortest;                  ///< line across that has a direction [m]
};

/// Of the warp line through a node, or of its weft line; it has two links there.
TurningJoint turningJoint(const ClothPattern& pattern, bool warp, int row, int column) noexcept;

/// A turn, and what its sine depends on.
struct Turn {
  double sine;
  Vec3 t, next;  ///< the links' directions, in rest lengths
  Vec3 axis;     ///< n
  Vec3 cross;    ///< t x t'
  double reach;  ///< of the line across [m]
  bool folded;   ///< it has no direction
};

/// Folded onto itself a line across has no direction: there the axis shortens with it, so that forces stay bounded.
inline Turn turnOf(const TurningJoint& joint, const Field3& position) noexcept {
  Turn turn;
  const Vec3 here = position.at(joint.node);
  turn.t = joint.per_before * (here - position.at(joint.before));
  turn.next = joint.per_after * (position.at(joint.after) - here);
  const Vec3 across = position.at(joint.right) - position.at(joint.left);
  const double length = across.norm();
  turn.folded = length < joint.shortest;
  turn.reach = turn.folded ? joint.shortest : length;
  turn.axis = across / turn.reach;
  turn.cross = turn.t.cross(turn.next);
  turn.sine = turn.axis.dot(turn.cross);
  return turn;
}

/// Adds moment [N m] times the slope of the sine to the force [N]. The slope by t is t' x n, by t' n x t, and by the
/// vector d that n = d / |d| is of, (c - n (n . c)) / |d| with c = t x t'.
inline void addCouple(const TurningJoint& joint, const Turn& turn, double moment, Field3& force) noexcept {
  const Vec3 on_before = moment * joint.per_before * turn.next.cross(turn.axis);
  const Vec3 on_after = moment * joint.per_after * turn.axis.cross(turn.t);
  const Vec3 on_axis =
      moment / turn.reach * (turn.folded ? turn.cross : Vec3(turn.cross - turn.axis.dot(turn.cross) * turn.axis));
  force.add(joint.before, -on_before);
  force.add(joint.node, on_before - on_after);
  force.add(joint.after, on_after);
  force.add(joint.right, on_axis);
  force.add(joint.left, -on_axis);
}

}  // namespace curtain
