// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 1: the fine mesh as it is drawn with a pattern on it. A row of a closed cloth ends with its first column again:
// the pattern's coordinate runs on there.
#pragma once

#include <cstdint>
#include <vector>

#include "curtain_sim/fine_mesh.h"

namespace curtain {

/// Where a vertex is on the cloth.
struct ClothCoordinate {
  float along_weft;  ///< from the first column on [m]
  float along_warp;  ///< from the hung edge down [m]
};

/// The constant part of a drawn mesh.
struct DrawnMesh {
  FineMeshTopology topology;                 ///< of the vertices; never closed
  std::vector<ClothCoordinate> coordinates;  ///< of the vertices, row by row
  std::vector<std::uint32_t> nodes;          ///< of the vertices: which of the fine mesh each is
};

/// cloth      valid; its rows, columns, folds, slits and whether it is closed are read
/// warp_rest  rest lengths of the rods between two rows [m], shape [rows - 1]
/// weft_rest  rest lengths of the weft links [m], row by row, as FineMeshBuilder takes them
/// Rows may be of different length (a skirt's hem): coordinates follow the columns, at their mean distance. Throws
/// std::invalid_argument for another number of lengths. Thread-safe.
DrawnMesh makeDrawnMesh(const ClothParams& cloth, const std::vector<double>& warp_rest,
                        const std::vector<double>& weft_rest);

}  // namespace curtain
