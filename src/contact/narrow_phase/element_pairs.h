// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of elements of the first layer's mesh, by the indices of their nodes in a Field. Every element belongs to one
// quad (cloth/coarse_mesh.h), so the pairs of quads give each pair of elements once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "cloth/cloth.h"
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

/// Appends without reallocation; false: the list is full.
template <typename Item>
bool addWithinRoom(const Item& item, std::vector<Item>& list) noexcept {
  if (list.size() == list.capacity()) return false;
  list.push_back(item);
  return true;
}

struct Candidates {
  std::vector<VertexTriangle> vertex_triangles;
  std::vector<EdgeEdge> edge_edges;
  std::size_t room = std::numeric_limits<std::size_t>::max();  ///< largest number of either kind
  bool full = false;                                           ///< some were dropped for lack of room

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

  /// Limits and reserves the number of pairs of either kind.
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

/// Enumerates pairs of elements that have no common node and one that can move.
class ElementPairs {
 public:
  /// For cloth without pins.
  explicit ElementPairs(const Grid& grid) : grid_(grid), immovable_(grid.size(), 0) {}
  explicit ElementPairs(const ClothPattern& pattern) : grid_(pattern.grid), immovable_(pattern.grid.size()) {
    takePins(pattern);
  }

  /// Which nodes can't move.
  void takePins(const ClothPattern& pattern) noexcept {
    for (std::size_t n = 0; n < immovable_.size(); ++n) immovable_[n] = pattern.inverse_mass[n] == 0.0 ? 1 : 0;
  }

  bool canMove(const std::array<std::uint32_t, 4>& nodes) const noexcept {
    return (immovable_[nodes[0]] & immovable_[nodes[1]] & immovable_[nodes[2]] & immovable_[nodes[3]]) == 0;
  }

  /// Calls vertex(nodes) and edge(nodes) for the pairs of the quads at (row_p, column_p) and (row_q, column_q), which
  /// may be the same.
  template <typename Vertex, typename Edge>
  void forEach(int row_p, int column_p, int row_q, int column_q, const Vertex& vertex, const Edge& edge) const {
    const QuadElements p = quadElements(grid_, row_p, column_p), q = quadElements(grid_, row_q, column_q);
    const bool one = row_p == row_q && column_p == column_q;
    forEachOf(p, q, vertex);
    if (!one) forEachOf(q, p, vertex);
    for (int k = 0; k < p.edge_count; ++k) {
      for (int l = one ? k + 1 : 0; l < q.edge_count; ++l) {
        const MeshEdge &a = p.edges[static_cast<std::size_t>(k)], &b = q.edges[static_cast<std::size_t>(l)];
        if (a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
        const std::array<std::uint32_t, 4> nodes{a[0], a[1], b[0], b[1]};
        if (canMove(nodes)) edge(nodes);
      }
    }
  }

 private:
  template <typename Vertex>
  void forEachOf(const QuadElements& p, const QuadElements& q, const Vertex& vertex) const {
    for (int k = 0; k < p.vertex_count; ++k) {
      const std::uint32_t v = p.vertices[static_cast<std::size_t>(k)];
      for (int l = 0; l < q.triangle_count; ++l) {
        const MeshTriangle& t = q.triangles[static_cast<std::size_t>(l)];
        if (v == t[0] || v == t[1] || v == t[2]) continue;
        const std::array<std::uint32_t, 4> nodes{v, t[0], t[1], t[2]};
        if (canMove(nodes)) vertex(nodes);
      }
    }
  }

  Grid grid_;
  std::vector<std::uint8_t> immovable_;  // by node
};

}  // namespace curtain
