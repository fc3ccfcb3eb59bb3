// SPDX-License-Identifier: BSD-3-Clause
//
// Inverse inertia of the nodes in a substep: damping takes a share of it, and mass scaling increases the inertia of
// nodes that their links' tensions would make oscillate too fast for the step. The frequency is Gershgorin's bound on
// the transverse oscillations of the taut net, omega^2 <= max 2 w sum |s| / (h kick).
#pragma once

#include "step/substep.h"

namespace curtain {

class NodeInertia {
 public:
  explicit NodeInertia(const ClothPattern& pattern);

  /// Prepares a substep whose forces act for `kick` [s], scale = h * kick [s^2]. max_phase: h * omega from which nodes
  /// are mass-scaled; 0: never. implicit: damping acts on the velocities at the end.
  void set(const NodeForces& forces, double kick, double scale, double max_phase, bool implicit) noexcept;

  /// Bound of the squares of the frequencies of explicit elastic forces [1/s^2], beside which tensions act.
  void setElastic(double omega_squared) noexcept { elastic_ = omega_squared; }
  double elastic() const noexcept { return elastic_; }
  /// Share of their stiffness that a step of this scale [s^2] bears; 1 but where steps could not follow them. It does
  /// not depend on the tensions, which would make it another stiffness, and energy, in every substep. explicit_links:
  /// as ElasticPart::begin() has it.
  double elasticShare(double scale, bool explicit_links) const noexcept;

  /// The pattern's pins have changed.
  void pinsChanged() noexcept;
  /// Largest of the last substep's loads over its mass, by the present pins.
  double heaviest() const noexcept;
  /// Guided nodes move from now on; false: they have no inverse inertia either.
  void setGuided(bool move) noexcept;

  const Field& inverse() const noexcept { return *inverse_; }  ///< [1/kg]
  const Field& masses() const noexcept { return *masses_; }    ///< without damping and mass scaling [1/kg]
  /// Share of its velocity that damping leaves a node; null: all.
  const Field* keep() const noexcept { return damped_ ? &keep_ : nullptr; }
  bool massesAlone() const noexcept { return inverse_ == masses_; }

  /// The last substep's tensions; restored when substeps are repeated.
  struct Tensions {
    Field load;             ///< sum of |multiplier| of each node's links [kg]
    double heaviest = 0.0;  ///< largest load over mass
    double scale = 0.0;     ///< h * kick of the substep [s^2]; 0: there was none

    void serialize(Archive& archive);
  };
  const Tensions& tensions() const noexcept { return tensions_; }
  Tensions& tensions() noexcept { return tensions_; }
  void forget() noexcept;
  double omegaSquared() const noexcept;  ///< of both [1/s^2]

  /// Largest step with h * omega <= max_phase when mass scaling may add this share of the cloth's mass [s]; infinite
  /// without tensions.
  double stepForPhase(double max_phase, double scaling_share) const noexcept;

 private:
  double addedMass(double per_load) const noexcept;

  const ClothPattern& pattern_;
  Field guided_move_, guided_stand_;  // inverse masses, of guided nodes too, or not [1/kg]; of held nodes 0
  const Field* masses_;               // one of these
  double free_mass_;                  // [kg]
  Field changed_, keep_;
  const Field* inverse_;
  bool damped_ = false;
  double elastic_ = 0.0;  // [1/s^2]
  Tensions tensions_;
};

}  // namespace curtain
