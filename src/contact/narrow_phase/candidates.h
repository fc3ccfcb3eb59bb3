// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of elements of the first layer's mesh that may be near each other; indices are those of the nodes in a Field.
#pragma once

#include <limits>
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

/// Adds to a list that never grows; false: there is no room.
template <typename Item>
bool addWithinRoom(const Item& item, std::vector<Item>& list) noexcept {
  if (list.size() == list.capacity()) return false;
  list.push_back(item);
  return true;
}

struct Candidates {
  std::vector<VertexTriangle> vertex_triangles;
  std::vector<EdgeEdge> edge_edges;
  std::size_t room = std::numeric_limits<std::size_t>::max();  ///< of either kind
  bool full = false;                                           ///< there are more, for which there was no room

  void add(const VertexTriangle& pair) {
    if (vertex_triangles.size() < room)
      vertex_triangles.push_back(pair);
    else
      full = true;
  }
  void add(const EdgeEdge& pair) {
    if (edge_edges.size() < room)
      edge_edges.push_back(pair);
    else
      full = true;
  }

  /// No more than so many from now on, without an allocation.
  void reserve(std::size_t count) {
    room = count;
    vertex_triangles.reserve(count);
    edge_edges.reserve(count);
  }
  /// Keeps the capacity.
  void clear() noexcept {
    vertex_triangles.clear();
    edge_edges.clear();
    full = false;
  }
};

}  // namespace curtain
