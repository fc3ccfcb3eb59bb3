// SPDX-License-Identifier: BSD-3-Clause
#include "curtain_sim/fine_mesh.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "cloth/cloth.h"
#include "cloth/folds.h"

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

struct FineMeshBuilder::Impl {
  Grid grid;
  int folds, fine_columns;
  FoldShape shape;
  Field weft_rest;  // at the link's right node
  Field3 position, area_vectors;

  /// Column of a link's right node.
  int rightOf(int link) const { return (link + 1) % grid.columns; }
};

FineMeshBuilder::FineMeshBuilder(const ClothParams& cloth, const std::vector<double>& weft_rest) {
  const Grid grid = makeGrid(cloth);
  const int links = grid.linkCount();
  const std::size_t count = static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(links);
  if (weft_rest.size() != count) {
    throw std::invalid_argument("weft_rest: has " + std::to_string(weft_rest.size()) + " lengths, must have " +
                                std::to_string(count));
  }
  impl_ = std::make_unique<Impl>(
      Impl{grid, cloth.folds, makeFineMeshTopology(cloth).columns, FoldShape(cloth.folds), {}, {}, {}});
  impl_->weft_rest.assign(grid.size(), 1.0);
  impl_->position.assign(grid.size(), 0.0);
  impl_->area_vectors.assign(grid.size(), 0.0);
  auto rest = weft_rest.begin();
  for (int i = 0; i < grid.rows; ++i) {
    for (int link = 0; link < links; ++link, ++rest) {
      if (!(*rest > 0.0)) throw std::invalid_argument("weft_rest: must be > 0, is " + std::to_string(*rest));
      impl_->weft_rest[grid.index(i, impl_->rightOf(link))] = *rest;
    }
  }
}

FineMeshBuilder::~FineMeshBuilder() = default;
FineMeshBuilder::FineMeshBuilder(FineMeshBuilder&&) noexcept = default;
FineMeshBuilder& FineMeshBuilder::operator=(FineMeshBuilder&&) noexcept = default;

void FineMeshBuilder::build(const std::vector<Vec3>& nodes, FineMesh& out) {
  Impl& im = *impl_;
  const Grid& grid = im.grid;
  if (nodes.size() != grid.nodeCount()) {
    throw std::invalid_argument("nodes: there are " + std::to_string(nodes.size()) + ", must be " +
                                std::to_string(grid.nodeCount()));
  }
  auto node = nodes.begin();
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) im.position.set(grid.index(i, j), *node++);
  }
  nodeAreaVectors(grid, im.position, im.area_vectors);
  out.positions.resize(static_cast<std::size_t>(grid.rows) * static_cast<std::size_t>(im.fine_columns));
  out.flattened_folds = 0;
  const int folds = im.folds;
  Vec3* row = out.positions.data();
  for (int i = 0; i < grid.rows; ++i, row += im.fine_columns) {
    for (int j = 0; j < grid.columns; ++j) row[j * folds] = im.position.at(grid.index(i, j));
    for (int link = 0; link < grid.linkCount(); ++link) {
      Vec3* const inner = row + link * folds + 1;
      const int right = im.rightOf(link);
      if (grid.hasLink(i, right)) {
        im.shape.place(foldArc(grid, im.weft_rest, im.position, im.area_vectors, i, right), inner);
      } else {  // no triangle has these nodes
        std::fill_n(inner, folds - 1, im.position.at(grid.index(i, right)));
      }
    }
  }
}

}  // namespace curtain
