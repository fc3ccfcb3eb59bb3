// SPDX-License-Identifier: BSD-3-Clause
//
// How a scene's lengths are shared among the cloth's rods, links and rows.
#pragma once

#include <numeric>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// The total in proportion to weights; without weights in `count` equal parts.
inline std::vector<double> shareOut(double total, const std::vector<double>& weights, int count) {
  if (weights.empty()) return std::vector<double>(static_cast<std::size_t>(count), total / count);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  std::vector<double> shares = weights;
  for (double& share : shares) share = share / sum * total;
  return shares;
}

/// Weft length of the hem, the bottom row [m].
inline double hemWidth(const ClothParams& cloth) { return cloth.hem_width.value_or(cloth.width); }

/// Weft length of the row at a share of the height down [m].
inline double rowWidth(const ClothParams& cloth, double down) {
  return cloth.width + (hemWidth(cloth) - cloth.width) * down;
}

}  // namespace curtain
