// SPDX-License-Identifier: BSD-3-Clause
//
// Triangles and edges of the first layer. All quads of the grid are cut along the same diagonal; every vertex, edge and
// triangle is owned by exactly one quad, so that a loop over quads visits each once.
//
//      (i,j) ----- (i,j+1)        quad (i,j) owns its upper left vertex, its upper and left edge, the diagonal
//        |       /    |           and both triangles; a quad of the last row owns its lower edge and lower left
//        |    /       |           vertex too, one of the last column of open cloth its right edge and upper
//     (i+1,j) --- (i+1,j+1)       right vertex, and the one in the corner the corner.
//
// A quad that a slit takes away has no triangles and no diagonal; what else it owns is there if its nodes are linked.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cloth/field.h"

namespace curtain {

using MeshEdge = std::array<std::uint32_t, 2>;
using MeshTriangle = std::array<std::uint32_t, 3>;

/// Indices are those of the nodes in a Field.
struct CoarseMesh {
  std::vector<MeshTriangle> triangles;
  std::vector<MeshEdge> edges;
};

/// Both triangles of every quad and every edge, row by row.
CoarseMesh makeCoarseMesh(const Grid& grid);

/// Elements of one quad; indices are those of the nodes in a Field.
struct QuadElements {
  std::array<std::uint32_t, 4> corners;  ///< upper left, upper right, lower left, lower right
  std::array<MeshTriangle, 2> triangles;
  std::array<std::uint32_t, 4> vertices;  ///< the first vertex_count are owned
  std::array<MeshEdge, 5> edges;          ///< the first edge_count are owned
  int triangle_count = 2;                 ///< 0: a slit
  int vertex_count = 0;
  int edge_count = 0;
};

/// Quad at row i in [0, rows - 1) and column j in [0, linkCount()). Thread-safe.
inline QuadElements quadElements(const Grid& grid, int i, int j) noexcept {
  const int right = j + 1 < grid.columns ? j + 1 : 0;
  const bool last_row = i + 2 == grid.rows;
  const bool last_column = !grid.closed && j + 2 == grid.columns;
  const auto a = static_cast<std::uint32_t>(grid.index(i, j));
  const auto b = static_cast<std::uint32_t>(grid.index(i, right));
  const auto c = static_cast<std::uint32_t>(grid.index(i + 1, j));
  const auto d = static_cast<std::uint32_t>(grid.index(i + 1, right));
  QuadElements quad{{a, b, c, d}, {{{a, c, b}, {b, c, d}}}, {a, b, c, d}, {}, 2, 1, 0};
  const auto own = [&quad](MeshEdge edge) { quad.edges[static_cast<std::size_t>(quad.edge_count++)] = edge; };
  const bool is_cloth = grid.hasQuad(i, right);
  if (is_cloth || grid.hasLink(i, right)) own({a, b});
  own({a, c});
  if (is_cloth) own({b, c});
  if (!is_cloth) quad.triangle_count = 0;
  if (last_column) {
    quad.vertices[static_cast<std::size_t>(quad.vertex_count++)] = b;
    own({b, d});
  }
  if (last_row) {
    quad.vertices[static_cast<std::size_t>(quad.vertex_count++)] = c;
    if (is_cloth) own({c, d});
  }
  if (last_row && last_column) quad.vertices[static_cast<std::size_t>(quad.vertex_count++)] = d;
  return quad;
}

}  // namespace curtain
