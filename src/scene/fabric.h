// SPDX-License-Identifier: BSD-3-Clause
//
// What a cloth is made of, node by node: its own fabric, and those of its patches (PatchParams).
#pragma once

#include <array>

#include "curtain_sim/scene.h"

namespace curtain {

/// Values of ClothParams at a node.
struct Fabric {
  double surface_density;     ///< [kg/m^2]
  double porosity;            ///< [0..1]
  double bending_warp;        ///< [N m]
  double bending_weft;        ///< the same
  double bending_bias;        ///< the same
  double bending_hysteresis;  ///< [N]
  double shear;               ///< [N/m]

  /// Its values, in their order.
  std::array<double, 7> values() const noexcept {
    return {surface_density, porosity, bending_warp, bending_weft, bending_bias, bending_hysteresis, shear};
  }
  bool bends() const noexcept { return bending_warp > 0.0 || bending_weft > 0.0; }
  /// Of twist: what warp and weft do not give of the rigidity along the bias [N m].
  double twist() const noexcept;
  /// Of a weft that resists shortening until it buckles [N m]; 0: it shortens freely.
  double push() const noexcept { return shear > 0.0 ? bending_weft : 0.0; }
};

/// Of the cloth's own fabric; a patch is over it.
Fabric fabricOf(const ClothParams& cloth) noexcept;

/// Of a node of the cloth; column: of its own.
Fabric fabricAt(const ClothParams& cloth, int row, int column) noexcept;

/// The same cloth all of the fabric that most of its nodes have, without patches.
ClothParams prevailingFabric(const ClothParams& cloth);

/// The cloth has fabric of this kind somewhere.
template <typename Is>
bool anyFabric(const ClothParams& cloth, const Is& is) {
  if (cloth.patches.empty()) return is(fabricOf(cloth));
  for (int i = 0; i < cloth.rows; ++i) {
    for (int j = 0; j < cloth.columns; ++j) {
      if (is(fabricAt(cloth, i, j))) return true;
    }
  }
  return false;
}

}  // namespace curtain
