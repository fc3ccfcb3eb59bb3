// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of elements of the first layer's mesh that may be near each other; indices are those of the nodes in a Field.
#pragma once

#include <vector>

#include "cloth/coarse_mesh.h"

namespace curtain {

struct VertexTriangle {
  std::uint32_t vertex;
  MeshTriangle triangle;
};

struct EdgeEdge {
  MeshEdge first;
  MeshEdge second;
};

struct Candidates {
  std::vector<VertexTriangle> vertex_triangles;
  std::vector<EdgeEdge> edge_edges;

  void reserve(std::size_t count) {
    vertex_triangles.reserve(count);
    edge_edges.reserve(count);
  }
  /// Keeps the capacity.
  void clear() noexcept {
    vertex_triangles.clear();
    edge_edges.clear();
  }
};

}  // namespace curtain
