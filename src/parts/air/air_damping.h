// SPDX-License-Identifier: BSD-3-Clause
//
// Air damping, Cheng 2000, Eq. (4), per area of cloth.
#pragma once

#include "cloth/cloth.h"
#include "curtain_sim/scene.h"

namespace curtain {

/// Damping coefficients of the nodes [kg/s]: force = -coefficient * velocity.
class AirDamping {
 public:
  AirDamping(const AirParams& air, const ClothPattern& pattern);

  /// False: no coefficient is above zero and there is nothing to do.
  bool active() const { return active_; }

  /// The largest coefficient of a node at rest, over its mass [1/s].
  double strongestPerMass(const ClothPattern& pattern) const noexcept;

  /// Adds the coefficients at the nodes' present speeds to out, shape [grid.size()].
  void addCoefficients(const Grid& grid, const Field3& velocity, Field& out) const noexcept;

 private:
  AirParams air_;
  Field linear_;  // rho * c_r * area of every node [kg/s]
  bool active_ = false;
};

/// Coefficient of Eq. (4) at a speed, over its value at small speeds. As printed, it jumps at the threshold; divided by
/// the threshold it does not.
inline double dampingGrowth(const AirParams& air, double speed) {
  const double beyond = air.law == AirLaw::kPrinted ? speed : speed / air.threshold;
  return (1.0 + air.fast_gain * speed) * (speed > air.threshold ? beyond : 1.0);
}

}  // namespace curtain
