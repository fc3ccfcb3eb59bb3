// SPDX-License-Identifier: BSD-3-Clause
#include "scene/fabric.h"

#include <algorithm>
#include <map>

namespace curtain {
namespace {

bool isWithin(const std::vector<int>& block, int place) noexcept {
  return block.size() != 2 || (place >= block[0] && place <= block[1]);
}

}  // namespace

double Fabric::twist() const noexcept { return std::max(0.0, bending_bias - 0.25 * (bending_warp + bending_weft)); }

Fabric fabricOf(const ClothParams& cloth) noexcept {
  return {cloth.surface_density, cloth.porosity,           cloth.bending_warp, cloth.bending_weft,
          cloth.bending_bias,    cloth.bending_hysteresis, cloth.shear};
}

Fabric fabricAt(const ClothParams& cloth, int row, int column) noexcept {
  Fabric fabric = fabricOf(cloth);
  for (const PatchParams& patch : cloth.patches) {
    if (!isWithin(patch.rows, row) || !isWithin(patch.columns, column)) continue;
    fabric = {patch.surface_density.value_or(fabric.surface_density),
              patch.porosity.value_or(fabric.porosity),
              patch.bending_warp.value_or(fabric.bending_warp),
              patch.bending_weft.value_or(fabric.bending_weft),
              patch.bending_bias.value_or(fabric.bending_bias),
              patch.bending_hysteresis.value_or(fabric.bending_hysteresis),
              patch.shear.value_or(fabric.shear)};
  }
  return fabric;
}

void addPatch(const PatchParams& patch, ClothParams& cloth) {
  const auto covers = [](const std::vector<int>& block, const std::vector<int>& other, int count) {
    const std::vector<int> all = {0, count - 1}, &inner = other.size() == 2 ? other : all;
    return isWithin(block, inner[0]) && isWithin(block, inner[1]);
  };
  const auto covered = [&](const PatchParams& other) {
    return covers(patch.rows, other.rows, cloth.rows) && covers(patch.columns, other.columns, cloth.columns);
  };
  cloth.patches.erase(std::remove_if(cloth.patches.begin(), cloth.patches.end(), covered), cloth.patches.end());
  const bool gives = patch.surface_density || patch.porosity || patch.bending_warp || patch.bending_weft ||
                     patch.bending_bias || patch.bending_hysteresis || patch.shear;
  if (gives) cloth.patches.push_back(patch);
}

ClothParams prevailingFabric(const ClothParams& cloth) {
  ClothParams whole = cloth;
  whole.patches.clear();
  if (cloth.patches.empty()) return whole;
  std::map<std::array<double, 7>, int> counts;
  for (int i = 0; i < cloth.rows; ++i) {
    for (int j = 0; j < cloth.columns; ++j) ++counts[fabricAt(cloth, i, j).values()];
  }
  const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto& most = std::max_element(counts.begin(), counts.end(), fewer)->first;
  whole.surface_density = most[0];
  whole.porosity = most[1];
  whole.bending_warp = most[2];
  whole.bending_weft = most[3];
  whole.bending_bias = most[4];
  whole.bending_hysteresis = most[5];
  whole.shear = most[6];
  return whole;
}

}  // namespace curtain
