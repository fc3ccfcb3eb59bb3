// SPDX-License-Identifier: BSD-3-Clause
//
// Strips: parts of flat cloth that slits cut from the hung edge down to the hem. With hang.overlap they hang like those
// of a strip door, board on board, alternately on two lines:
//
//   seen from above      ___0___     ___2___     ___4___
//                             ___1___     ___3___          |--| overlap
#pragma once

#include <numeric>
#include <vector>

#include "curtain_sim/scene.h"
#include "scene/heading.h"

namespace curtain {

/// Number of the strip that each column belongs to, from 0, shape [columns].
inline std::vector<int> stripNumbers(const ClothParams& cloth) {
  std::vector<int> begins(static_cast<std::size_t>(cloth.columns), 0);
  for (const SlitParams& slit : cloth.slits) {
    const std::size_t first = static_cast<std::size_t>(slit.column) + 1;
    if (slit.from_row == 0 && first < begins.size()) begins[first] = 1;
  }
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  return begins;
}

/// Distances of neighbouring columns along the hung edge [m], shape [columns - 1]: the links' lengths, and minus the
/// overlap, if there is one, where a strip begins.
inline std::vector<double> edgeWidths(const Scene& scene) {
  std::vector<double> widths = edgeLinks(scene.cloth);
  if (!scene.hang.overlap) return widths;
  const std::vector<int> strips = stripNumbers(scene.cloth);
  for (std::size_t j = 0; j < widths.size(); ++j) {
    if (strips[j + 1] != strips[j]) widths[j] = -*scene.hang.overlap;
  }
  return widths;
}

/// Length of the line that flat cloth hangs along at most [m].
inline double longestEdge(const Scene& scene) {
  if (!scene.hang.overlap) return scene.cloth.width;
  const std::vector<double> widths = edgeWidths(scene);
  return std::accumulate(widths.begin(), widths.end(), 0.0);
}

}  // namespace curtain
