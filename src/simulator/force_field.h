// SPDX-License-Identifier: BSD-3-Clause
//
// The sum of all forces on a cloth at the start of a substep: its weight, and what parts add.
#pragma once

#include "step/part.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor.
class ForceField {
 public:
  /// All arguments must outlive this.
  ForceField(const Scene& scene, const ClothPattern& pattern, const PartList& parts);

  void reset() noexcept;
  /// The scene's gravity has changed.
  void gravityChanged() noexcept;

  /// Before a substep of h [s] from this state at `time`, `done` seconds into its frame: asks the parts. True:
  /// evaluate() reads SubstepAhead.
  bool begin(const ClothState& state, double time, double done, double h) noexcept;
  /// Then: the forces.
  const NodeForces& evaluate(const ClothState& state, const SubstepAhead& ahead) noexcept;
  const NodeForces& last() const noexcept { return forces_; }

  void serialize(Archive& archive);

 private:
  const Scene& scene_;
  const ClothPattern& pattern_;
  const PartList& parts_;
  Field3 weight_;
  NodeForces forces_;
  ForceSum sum_;
};

}  // namespace curtain
