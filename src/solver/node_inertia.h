// SPDX-License-Identifier: BSD-3-Clause
//
// How nodes answer an impulse in a substep: damping takes a share, and nodes that their links' tensions would make
// swing too fast for the step are heavier. And what of the tensions tells how fast they swing: by Gershgorin's bound on
// the transverse oscillations of the taut net, omega^2 <= max 2 w sum |s| / (h kick).
#pragma once

#include "cloth/column_set.h"
#include "solver/substep.h"

namespace curtain {

class NodeInertia {
 public:
  explicit NodeInertia(const ClothPattern& pattern);

  /// For a substep whose forces act for `kick` [s], scale = h * kick [s^2]. most_phase: bound of h * omega from which
  /// nodes are heavier; 0: none is. implicit: damping as the backward formulas have it.
  void set(const NodeForces& forces, double kick, double scale, double most_phase, bool implicit) noexcept;

  /// From now on these columns answer nothing, as if pinned.
  void hold(const ColumnSet& columns) noexcept;

  const Field& inverse() const noexcept { return *inverse_; }  ///< [1/kg]
  const Field& masses() const noexcept { return *masses_; }    ///< the same of the masses alone [1/kg]
  const Field* keep() const noexcept {
    return damped_ ? &keep_ : nullptr;
  }  ///< share of its velocity a node keeps; null: all
  bool massesAlone() const noexcept { return inverse_ == masses_; }

  /// What the last substep's tensions say, to be put back when substeps are made again.
  struct Tensions {
    Field load;             ///< sum of |multiplier| of each node's links [kg]
    double heaviest = 0.0;  ///< the largest of it over the node's mass
    double scale = 0.0;     ///< the substep's h * kick [s^2]; 0 = there was none

    void carry(Archive& archive);
  };
  const Tensions& tensions() const noexcept { return tensions_; }
  Tensions& tensions() noexcept { return tensions_; }
  void forget() noexcept;
  double omegaSquared() const noexcept;  ///< [1/s^2]

  /// Largest step whose phase h * omega stays within most_phase when nodes may be heavier by so much altogether, as a
  /// share of the cloth's mass [s]; infinite when there are no tensions.
  double stepForPhase(double most_phase, double heavier_share) const noexcept;

 private:
  double heavierBy(double per_load) const noexcept;

  const ClothPattern& pattern_;
  double free_mass_;  // [kg]
  Field changed_, keep_, held_;
  const Field* masses_;  // the pattern's, or held_
  const Field* inverse_;
  bool damped_ = false;
  Tensions tensions_;
};

}  // namespace curtain
