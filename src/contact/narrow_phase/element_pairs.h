// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of elements of the first layer's mesh, by their nodes. Every element belongs to one quad (cloth/coarse_mesh.h),
// so the pairs of quads give each pair of elements once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
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

/// Calls vertex(nodes) and edge(nodes) for the pairs of a vertex and a triangle, or of two edges, of two quads (or of
/// one with itself) that have no common node.
template <typename Vertex, typename Edge>
void forEachElementPair(const QuadElements& p, const QuadElements& q, const Vertex& vertex, const Edge& edge) {
  const auto vertices = [&](const QuadElements& one, const QuadElements& other) {
    for (int k = 0; k < one.vertex_count; ++k) {
      const std::uint32_t v = one.vertices[static_cast<std::size_t>(k)];
      for (int l = 0; l < other.triangle_count; ++l) {
        const MeshTriangle& t = other.triangles[static_cast<std::size_t>(l)];
        if (v != t[0] && v != t[1] && v != t[2]) vertex(std::array<std::uint32_t, 4>{v, t[0], t[1], t[2]});
      }
    }
  };
  const bool one = p.corners == q.corners;
  vertices(p, q);
  if (!one) vertices(q, p);
  for (int k = 0; k < p.edge_count; ++k) {
    for (int l = one ? k + 1 : 0; l < q.edge_count; ++l) {
      const MeshEdge &a = p.edges[static_cast<std::size_t>(k)], &b = q.edges[static_cast<std::size_t>(l)];
      if (a[0] != b[0] && a[0] != b[1] && a[1] != b[0] && a[1] != b[1])
        edge(std::array<std::uint32_t, 4>{a[0], a[1], b[0], b[1]});
    }
  }
}

}  // namespace curtain
