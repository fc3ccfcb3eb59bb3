// SPDX-License-Identifier: BSD-3-Clause
#include "cloth/coarse_mesh.h"

namespace curtain {

CoarseMesh makeCoarseMesh(const Grid& grid) {
  CoarseMesh mesh;
  for (int i = 0; i + 1 < grid.rows; ++i) {
    for (int j = 0; j < grid.linkCount(); ++j) {
      const QuadElements quad = quadElements(grid, i, j);
      mesh.triangles.insert(mesh.triangles.end(), quad.triangles.begin(), quad.triangles.begin() + quad.triangle_count);
      mesh.edges.insert(mesh.edges.end(), quad.edges.begin(), quad.edges.begin() + quad.edge_count);
    }
  }
  return mesh;
}

}  // namespace curtain
