// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 1: the triangulated mesh of both layers of nodes, for display and export.
//
//   fine column   0   1   2 … k-1   k   k+1 …          first-layer nodes at multiples of k,
//   row i         o---.---.-- … .---o---.-- …           second-layer nodes between them
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// The constant part of a fine mesh.
struct FineMeshTopology {
  int rows = 0;           ///< of the grid
  int columns = 0;        ///< fine columns: links * folds + 1, closed cloth: links * folds
  int folds = 1;          ///< rods per weft link
  bool closed = false;    ///< the rows are rings
  std::vector<char> cut;  ///< by row and weft link: a slit takes the strip below away; empty: none is
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< indices into FineMesh::positions, of equal winding
};

/// Whether there is cloth between rows `row` and row + 1 at the weft link with this number.
inline bool hasStrip(const FineMeshTopology& topology, int row, int link) {
  const int links = (topology.closed ? topology.columns : topology.columns - 1) / topology.folds;
  return topology.cut.empty() || topology.cut[static_cast<std::size_t>(row * links + link)] == 0;
}

/// The moving part of a fine mesh; shape [rows * columns], row-major.
struct FineMesh {
  std::vector<Vec3> positions;  ///< [m]
  /// Folds without room beside an obstacle: their nodes were moved out of it, so their rods are longer or shorter than
  /// rest / k. All other rods keep their length (or, where the link is taut, lie evenly on it).
  int flattened_folds = 0;
};

/// cloth must be valid.
FineMeshTopology makeFineMeshTopology(const ClothParams& cloth);

/// Unit normals of the fine mesh's nodes (area-weighted mean of the faces at the node); out is resized.
void fineMeshNormals(const FineMeshTopology& topology, const FineMesh& mesh, std::vector<Vec3>& out);

/// The same for other triangles over the same nodes, such as MeshReducer's. Nodes without a triangle get +z.
void fineMeshNormals(const std::vector<std::array<std::uint32_t, 3>>& triangles, const FineMesh& mesh,
                     std::vector<Vec3>& out);

/// Places the second layer's nodes between given first-layer nodes, as Simulator::copyFineMesh() does where no obstacle
/// is near: for viewers, which get the nodes alone. Not thread-safe. Allocates in the constructor and for a larger
/// `out`.
class FineMeshBuilder {
 public:
  /// cloth      valid; its rows, columns, folds, slits and whether it is closed are read
  /// weft_rest  rest lengths of the weft links [m], > 0, row by row, shape [rows * links]; in closed cloth a row's last
  ///            link closes the ring
  /// Throws std::invalid_argument for another number of lengths, or one that is not > 0.
  FineMeshBuilder(const ClothParams& cloth, const std::vector<double>& weft_rest);
  ~FineMeshBuilder();
  FineMeshBuilder(FineMeshBuilder&&) noexcept;             ///< the other one may only be destroyed or assigned to
  FineMeshBuilder& operator=(FineMeshBuilder&&) noexcept;  ///< as above

  /// nodes  first-layer nodes [m], finite, row-major; throws std::invalid_argument for another number of them
  void build(const std::vector<Vec3>& nodes, FineMesh& out);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace curtain
