// SPDX-License-Identifier: BSD-3-Clause
//
// Air damping, Cheng 2000, Eq. (4), per area of cloth.
#pragma once

#include "cloth/cloth.h"
#include "step/part.h"

namespace curtain {

/// Damping coefficients of the nodes [kg/s]: force = -coefficient * velocity.
class AirDamping final : public Part {
 public:
  /// All that the arguments refer to must outlive this. Layers may have their own coefficients.
  AirDamping(const AirParams& air, const Layers& layers, const ClothPattern& pattern);

  /// False: no coefficient is above zero and there is nothing to do.
  bool active() const { return active_; }

  /// Adds the coefficients at the nodes' present speeds to out, shape [grid.size()].
  void addCoefficients(const Field3& velocity, Field& out) const noexcept;

  void resume() override;
  bool explain(const ClothState& state, double time, Plan& plan) const override;
  double dampingPerMass(double& air_speed) const noexcept override;
  void announce(const ClothState&, ForceSum& sum) noexcept override { sum.damps = sum.damps || active_; }
  void addForces(const ClothState& state, ForceSum& sum) noexcept override {
    if (active_) addCoefficients(state.velocity, sum.damping);
  }

 private:
  const AirParams& air_;
  const Layers layers_;
  const ClothPattern& pattern_;
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
