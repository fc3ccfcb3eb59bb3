// SPDX-License-Identifier: BSD-3-Clause
//
// Twist of the cloth: what it resists where it bends along the bias, beyond what its warp and weft lines do.
//
// A plate with the rigidities B_warp, B_weft and D_t has, where it bends along the bias, B_45 = (B_warp + B_weft) / 4 +
// D_t. Its twist k, the mixed derivative of the surface, stores 2 D_t k^2 for each area. The corners of a cell with the
// edges l and the area A enclose a tetrahedron of six times the volume V that twist opens, k = V / (l l l l), so a cell
// has the energy
//     E = 2 D_t A V^2 / (l l l l)^2,   V = (b - a) . ((c - a) x (d - a)).
// Flat cells, tapered or sheared ones too, have none of it, nor have those that bend along warp or weft.
//
// It is explicit, as shear is: a cell between nodes of mass m oscillates by omega^2 <= 64 D_t / (A m).
#pragma once

#include <optional>

#include "cloth/cell_sum.h"
#include "cloth/workers.h"
#include "curtain_sim/scene.h"
#include "step/explicit_part.h"
#include "step/part.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor, and nothing for cloth that does not resist twist.
class Twist final : public ExplicitPart, public Part {
 public:
  /// All that the arguments refer to must outlive this.
  Twist(const Layers& layers, const ClothPattern& pattern, const Workers& workers);

  bool any() const noexcept override { return omega_squared_ > 0.0; }
  bool explain(const ClothState& state, double time, Plan& plan) const override;

  double omegaSquared() const noexcept override { return omega_squared_; }

 protected:
  void addOwn(const Field3& position, Field3& sum) noexcept override;
  double energyAt(const Field3& position) const noexcept override;

 private:
  void twistCells(const Field3& position, int row, CellCorners& corners) const noexcept;
  void twistSeam(const Field3& position, int row, CellCorners& corners) const noexcept;

  const ClothPattern& pattern_;
  const Workers& workers_;
  const Layers layers_;
  double omega_squared_ = 0.0;  // bound [1/s^2]
  Field stiffness_;             // of the cell below this node, on its left: dE / dV = stiffness V [N/m^5]
  std::optional<CellSum> cells_;
};

}  // namespace curtain
