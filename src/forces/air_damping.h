// SPDX-License-Identifier: BSD-3-Clause
//
// Air damping, Cheng 2000, Eq. (4), per area of cloth, and its velocity update, which is stable for any coefficient and
// never reverses a velocity.
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

/// Velocity update v' = keep * v + gain * w * impulse of a node with damping coefficient c and inverse mass w over dt.
/// The exact factors are e^-z and (1 - e^-z) / z with z = c w dt; these rational ones agree to second order, are
/// positive for every z and keep the exact terminal velocity F / c:
///   keep = 1 / (1 + z + z^2/2),  gain = (1 + z/2) / (1 + z + z^2/2).
struct DampedStep {
  double keep;
  double gain;
};

inline DampedStep dampedStep(double coefficient, double inverse_mass, double dt) {
  const double z = coefficient * inverse_mass * dt;
  const double denominator = 1.0 + z + 0.5 * z * z;
  return {1.0 / denominator, (1.0 + 0.5 * z) / denominator};
}

/// The same with damping at the end of the step, v' = v + dt w (F - c v'), as backward Euler needs for its order;
/// also positive and with the exact terminal velocity.
inline DampedStep implicitlyDampedStep(double coefficient, double inverse_mass, double dt) {
  const double share = 1.0 / (1.0 + coefficient * inverse_mass * dt);
  return {share, share};
}

/// Coefficient of Eq. (4) at a speed, over its value at small speeds. As printed, it jumps at the threshold; divided by
/// the threshold it does not.
inline double dampingGrowth(const AirParams& air, double speed) {
  const double beyond = air.law == AirLaw::kPrinted ? speed : speed / air.threshold;
  return (1.0 + air.fast_gain * speed) * (speed > air.threshold ? beyond : 1.0);
}

}  // namespace curtain
