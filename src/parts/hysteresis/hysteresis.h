// SPDX-License-Identifier: BSD-3-Clause
//
// Friction within the fabric as it bends. Yarns slip on each other: the moment of a strip that is bent and unbent runs
// round a loop, whose width KES gives as 2HB [N], twice the friction's moment for each metre of width (Kawabata 1980).
//
// Each joint of the lines that bend has a Jenkin slider beside its spring: a spring of kSlider times the stiffness in
// series with friction,
//     M = clamp(K (sin(turn) - s), -HB w, HB w),
// w being the width of the line. s, which slips where the friction is reached, is all that it knows of the past. Within
// a substep s stands, so the force has a potential; what slips between substeps is lost.
//
// It is explicit, as shear is. Cloth with friction within rests in more than one place: where it stops depends on how
// it came there.
#pragma once

#include <vector>

#include "cloth/turning_joint.h"
#include "curtain_sim/scene.h"
#include "step/explicit_part.h"
#include "step/part.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor, and nothing for cloth without hysteresis.
class Hysteresis final : public ExplicitPart, public Part {
 public:
  /// All arguments must outlive this.
  Hysteresis(const Layers& layers, const ClothPattern& pattern);

  bool any() const noexcept override { return !slips_.empty(); }
  bool explain(const ClothState& state, double time, Plan& plan) const override;
  void reset(ClothState& state) override;
  void placed(const ClothState& before, ClothState& state) noexcept override;
  void serialize(Archive& archive) override;

  void pinsChanged() noexcept override;
  double omegaSquared() const noexcept override { return omega_squared_; }
  double commit(const Field3& position) noexcept override;
  void save(std::vector<double>& memory) const override;
  const double* restore(const double* memory) noexcept override;

 protected:
  void addOwn(const Field3& position, Field3& sum) noexcept override;
  double energyAt(const Field3& position) const noexcept override;

 private:
  struct Slider {
    TurningJoint joint;
    std::size_t slip;  // index of its s
    double stiffness;  // K [N m]
    double most;       // friction [N m]
  };
  void fill() noexcept;
  void startSlips() noexcept;

  const ClothPattern& pattern_;
  const Layers layers_;
  double omega_squared_ = 0.0;   // bound [1/s^2]
  std::vector<Slider> sliders_;  // with room for those of all joints, whether they are pinned or not
  std::vector<double> slips_;    // s, shape [2 grid.size()]: of warp lines, then of weft lines
  Field warp_length_, weft_length_;
};

}  // namespace curtain
