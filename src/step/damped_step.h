// SPDX-License-Identifier: BSD-3-Clause
//
// The velocity update of a damped node, which is stable for any coefficient and never reverses a velocity.
#pragma once

namespace curtain {

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

}  // namespace curtain
