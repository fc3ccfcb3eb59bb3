// SPDX-License-Identifier: BSD-3-Clause
//
// Lines that are not straight at rest. A joint whose rest is a turn of theta_0 about the axis n stores
//     k (1 - cos(theta - theta_0)) = k cos(theta_0) (1 - cos(theta)) + k (1 - cos(theta_0)) - k sin(theta_0)
//     sin(theta).
// The first term is that of a straight line (bending_lines.h) of stiffness k cos(theta_0), the second a constant, the
// third a couple on the two links (turning_joint.h).
#pragma once

#include "cloth/turning_joint.h"
#include "parts/bending/bending_lines.h"

namespace curtain {

class RestCurvature {
 public:
  /// Of the warp's lines, or of the weft's. pattern must outlive this.
  RestCurvature(const ClothPattern& pattern, bool warp);

  /// The pins of its pattern have changed. Allocates nothing.
  void pinsChanged() noexcept { fill(); }

  /// Part of the energy that does not change [J].
  double constant() const noexcept { return constant_; }
  bool any() const noexcept { return !couples_.empty(); }
  /// Adds the couples' force [N] at these positions. Returns their energy and the constant one [J].
  double addTo(const Field3& position, Field3& force) const noexcept;

 private:
  struct Couple {
    TurningJoint joint;
    double moment;    // k sin(theta_0) [N m]
    double constant;  // k (1 - cos(theta_0)) [J]
  };
  void fill() noexcept;

  const ClothPattern& pattern_;
  const bool warp_;
  std::vector<Couple> couples_;  // with room for all that turn at rest, whether they are pinned or not
  double constant_ = 0.0;
};

}  // namespace curtain
