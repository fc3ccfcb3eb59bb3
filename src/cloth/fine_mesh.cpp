// SPDX-License-Identifier: BSD-3-Clause
#include "curtain_sim/fine_mesh.h"

#include <algorithm>

namespace curtain {

FineMeshTopology makeFineMeshTopology(const ClothParams& cloth) {
  FineMeshTopology topology;
  topology.rows = cloth.rows;
  topology.folds = cloth.folds;
  topology.closed = cloth.closed;
  const int quad_columns = weftLinkCount(cloth) * cloth.folds;
  topology.columns = cloth.closed ? quad_columns : quad_columns + 1;
  const auto at = [&](int i, int f) { return static_cast<std::uint32_t>(i * topology.columns + f % topology.columns); };
  const int links = weftLinkCount(cloth);
  if (!cloth.slits.empty()) topology.cut.assign(static_cast<std::size_t>(cloth.rows * links), 0);
  for (const SlitParams& slit : cloth.slits) {
    for (int i = std::max(slit.from_row - 1, 0); i + 1 < cloth.rows; ++i)
      topology.cut[static_cast<std::size_t>(i * links + slit.column)] = 1;
  }
  topology.triangles.reserve(static_cast<std::size_t>(cloth.rows - 1) * static_cast<std::size_t>(quad_columns) * 2);
  for (int i = 0; i + 1 < cloth.rows; ++i) {
    for (int f = 0; f < quad_columns; ++f) {
      if (!hasStrip(topology, i, f / cloth.folds)) continue;
      // Winding: (below - here) x (right - here) has the direction of the node normals.
      topology.triangles.push_back({at(i, f), at(i + 1, f), at(i, f + 1)});
      topology.triangles.push_back({at(i, f + 1), at(i + 1, f), at(i + 1, f + 1)});
    }
  }
  return topology;
}

void fineMeshNormals(const FineMeshTopology& topology, const FineMesh& mesh, std::vector<Vec3>& out) {
  fineMeshNormals(topology.triangles, mesh, out);
}

void fineMeshNormals(const std::vector<std::array<std::uint32_t, 3>>& triangles, const FineMesh& mesh,
                     std::vector<Vec3>& out) {
  out.assign(mesh.positions.size(), Vec3::Zero());
  for (const auto& triangle : triangles) {
    const Vec3& a = mesh.positions[triangle[0]];
    const Vec3 area = (mesh.positions[triangle[1]] - a).cross(mesh.positions[triangle[2]] - a);
    for (const std::uint32_t corner : triangle) out[corner] += area;
  }
  for (Vec3& normal : out) {
    const double size = normal.norm();
    normal = size > 0.0 ? Vec3(normal / size) : Vec3::UnitZ();
  }
}

}  // namespace curtain
