// SPDX-License-Identifier: BSD-3-Clause
//
// Shear of the cloth in its plane: what a weave resists where warp and weft are not square any more.
//
// Each corner of a cell, between a weft edge e and a warp edge f, has the energy
//     E = G / (8 l_e l_f) (p -+ w)^2,   p = e . f - e_0 . f_0,
// with the rest lengths l: a quarter of G A s^2 / 2 of the cell's area A, where s = p / (l_e l_f) is the sine of the
// shear angle if links keep their lengths. e_0 . f_0 is that of the cloth laid flat, 0 but for tapered cloth. One point
// a cell instead of four would leave its hourglass modes free. G is the shear rigidity [N/m], force per width and
// angle, as textile laboratories measure it (Kawabata 1980).
//
// w is the part of p that has opposite signs at adjacent corners. With the mean edges E, F of a cell and
// q = a - b - c + d of its corners, e . f = (E +- q/2) . (F +- q/2), so w is a quarter of q . q: that of a cell that
// warps out of its plane, as it does where cloth rolls along the bias. Rolling shears nothing, but w would resist it by
// G (curvature l)^4 / 512 for each area, on coarse grids many times what bending does. Hourglasses in the plane keep
// their stiffness by E . q and F . q.
//
// It is explicit: a cell between nodes of mass m oscillates by omega^2 <= 4 G (l_e / l_f + l_f / l_e) / m, and steps
// follow that. Where they can't it is as stiff as the step bears.
#pragma once

#include <array>
#include <optional>

#include "cloth/cell_sum.h"
#include "cloth/workers.h"
#include "curtain_sim/scene.h"
#include "step/explicit_part.h"
#include "step/part.h"

namespace curtain {

/// Not thread-safe. Allocates only in the constructor, and nothing for cloth without shear rigidity.
class Shear final : public ExplicitPart, public Part {
 public:
  /// All that the arguments refer to must outlive this.
  Shear(const Layers& layers, const ClothPattern& pattern, const Workers& workers);

  bool any() const noexcept override { return omega_squared_ > 0.0; }
  bool explain(const ClothState& state, double time, Plan& plan) const override;

  double omegaSquared() const noexcept override { return omega_squared_; }

 protected:
  void addOwn(const Field3& position, Field3& sum) noexcept override;
  double energyAt(const Field3& position) const noexcept override;

 private:
  void shearCells(const Field3& position, int row, CellCorners& corners) const noexcept;
  void shearSeam(const Field3& position, int row, CellCorners& corners) const noexcept;

  const ClothPattern& pattern_;
  const Workers& workers_;
  const Layers layers_;
  double omega_squared_ = 0.0;  // bound [1/s^2]
  Field per_warp_, per_weft_;   // 1 / rest length [1/m]
  Field stiffness_;             // a quarter of G, of the cell below this node, on its left [N/m]; 0: there is none
  std::array<Field, 4> flat_;   // e_0 . f_0 of its corners: top left, top right, bottom left, bottom right [m^2]
  std::optional<CellSum> cells_;
};

}  // namespace curtain
