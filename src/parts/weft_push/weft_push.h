// SPDX-License-Identifier: BSD-3-Clause
//
// What keeps wefts from shortening within the cloth's plane: a weft link that is pressed together is straight until it
// buckles, and then folds below what the grid resolves. So every link pushes its ends apart with the Euler load of its
// own length, pi^2 B / l^2 for each metre of width, B being the bending rigidity along the weft; its string takes up
// what is too much. It needs no stiffness, and bounds no step.
//
// By itself it does nothing for folds, nor does shear: cloth collapses by either way that is left to it. So it comes
// with cloth.shear.
#pragma once

#include "curtain_sim/scene.h"
#include "step/explicit_part.h"
#include "step/part.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor, and nothing for cloth that does not shear or bend.
class WeftPush final : public ExplicitPart, public Part {
 public:
  /// pattern must outlive this.
  WeftPush(const Layers& layers, const ClothPattern& pattern);

  bool any() const noexcept override { return !load_.empty(); }
  bool explain(const ClothState& state, double time, Plan& plan) const override;

 protected:
  void addOwn(const Field3& position, Field3& sum) noexcept override;
  double energyAt(const Field3& position) const noexcept override;

 private:
  void addRow(const Field3& position, int row, Field3& sum) noexcept;

  const ClothPattern& pattern_;
  Field load_;   // of the link on the left of each node [N]; 0: there is none
  Field3 push_;  // of the links of a row [N], shape [stride]
};

}  // namespace curtain
