// SPDX-License-Identifier: BSD-3-Clause
//
// What a scheme is given for one substep, what it gives back, and what else may constrain the nodes meanwhile.
#pragma once

#include "cloth/cloth.h"
#include "solver/stage_clock.h"

namespace curtain {

/// Forces at the start of a substep.
struct NodeForces {
  const Field3* force = nullptr;  ///< [N], all but damping
  bool weight_only = true;        ///< force is mass times gravity
  Vec3 gravity = Vec3::Zero();    ///< [m/s^2]
  Field damping;                  ///< force = -damping * velocity [kg/s]; only read when has_damping
  bool has_damping = false;
};

/// Position constraints solved together with the links (contact).
class PositionConstraints {
 public:
  virtual ~PositionConstraints() = default;

  /// Finds what may touch on the way from start to predicted, over a substep of length h [s]. False: nothing. Allocates
  /// nothing.
  virtual bool begin(const ClothPattern& pattern, const Field3& start, const Field3& predicted, double h) noexcept = 0;

  /// Moves nodes so that the constraints hold; returns the largest move [m].
  virtual double project(Field3& position) noexcept = 0;

  /// The same for velocities: nodes that are pressed on neither enter nor leave.
  virtual void projectVelocity(Field3& velocity) noexcept = 0;
};

/// How a substep went.
struct SubstepOutcome {
  bool accepted = false;       ///< false: nothing was changed, try again with a smaller step
  bool settled = false;        ///< every link is within the tolerance
  int sweeps = 0;
  double scale = 0.0;          ///< h times the time the forces acted for [s^2]
  double omega_squared = 0.0;  ///< bound of the square of the highest frequency, from the links' tensions [1/s^2]
};

}  // namespace curtain
