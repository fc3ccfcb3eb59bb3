// SPDX-License-Identifier: BSD-3-Clause
//
// Which elements of the cloth may come near each other: down the tree, past what is flat or far apart.
#include <algorithm>
#include <cmath>
#include <limits>

#include "contact/cloth_tree.h"

namespace curtain {
namespace {

/// Most leaves (blocks or quads) that are merged to see whether two that are not siblings are flat together.
constexpr int kMostInHull = 9;

int area(const QuadRectangle& r) { return (r.row_end - r.row) * (r.column_end - r.column); }

/// The smallest rectangle that holds both; around the seam of `ring` columns (0: there is none) its column_end is
/// beyond them where that is shorter.
QuadRectangle hullOf(const QuadRectangle& one, const QuadRectangle& other, int ring) {
  QuadRectangle hull{std::min(one.row, other.row), std::max(one.row_end, other.row_end),
                     std::min(one.column, other.column), std::max(one.column_end, other.column_end)};
  if (ring == 0) return hull;
  const QuadRectangle& right = one.column < other.column ? other : one;
  const QuadRectangle& left = one.column < other.column ? one : other;
  if (right.column < left.column_end) return hull;
  const int around = left.column_end + ring - right.column;
  if (around < hull.column_end - hull.column) {
    hull.column = right.column;
    hull.column_end = right.column + around;
  }
  return hull;
}

bool shareNode(const MeshEdge& p, const MeshEdge& q) {
  return p[0] == q[0] || p[0] == q[1] || p[1] == q[0] || p[1] == q[1];
}

bool isCorner(std::uint32_t vertex, const MeshTriangle& t) {
  return vertex == t[0] || vertex == t[1] || vertex == t[2];
}

}  // namespace

/// The elements of a quad that come near something, with their boxes.
struct ClothTree::NearElements {
  template <typename Element, std::size_t N>
  struct List {
    std::array<Element, N> elements;
    std::array<FloatBox, N> boxes;
    std::size_t count = 0;
  };
  List<std::uint32_t, 4> vertices;
  List<MeshTriangle, 2> triangles;
  List<MeshEdge, 5> edges;

  NearElements(const QuadElements& quad, const std::vector<FloatBox>& node_boxes, const FloatBox& near, float reach) {
    const auto keep = [&](auto& list, const auto& element, const FloatBox& box) {
      list.elements[list.count] = element;  // kept only if counted
      list.boxes[list.count] = box;
      list.count += box.meets(near, reach) ? 1U : 0U;
    };
    for (int k = 0; k < quad.vertex_count; ++k) {
      const std::uint32_t vertex = quad.vertices[static_cast<std::size_t>(k)];
      keep(vertices, vertex, node_boxes[vertex]);
    }
    for (int k = 0; k < quad.edge_count; ++k) {
      const MeshEdge& edge = quad.edges[static_cast<std::size_t>(k)];
      FloatBox box = node_boxes[edge[0]];
      box.merge(node_boxes[edge[1]]);
      keep(edges, edge, box);
    }
    for (const MeshTriangle& triangle : quad.triangles) {
      FloatBox box = node_boxes[triangle[0]];
      box.merge(node_boxes[triangle[1]]);
      box.merge(node_boxes[triangle[2]]);
      keep(triangles, triangle, box);
    }
  }
};

void ClothTree::collectSelf(double reach, Candidates& out) noexcept {
  reach_ = static_cast<float>(reach) * (1.0f + 2.0f * std::numeric_limits<float>::epsilon()) + rounding_;
  self(0, out);
}

void ClothTree::self(std::uint32_t node, Candidates& out) noexcept {
  if (leastDistance(slopes_[node], rounding_) > reach_) return;
  const std::uint32_t second = nodes_[node].second;
  lookInto(node);
  if (second == kNone) {
    quadSelf(node, out);
    return;
  }
  self(node + 1, out);
  self(second, out);
  pair(node + 1, second, out);
}

void ClothTree::pair(std::uint32_t one, std::uint32_t other, Candidates& out) noexcept {
  if (!boxes_[one].meets(boxes_[other], reach_)) return;
  const Node &p = nodes_[one], &q = nodes_[other];
  if (p.second == kNone && q.second == kNone) {
    quadPair(one, other, out);
    return;
  }
  if (flatTogether(one, other)) return;
  const int area_p = area(p.quads), area_q = area(q.quads);
  const bool split_p = p.second != kNone && (area_p * 2 > area_q || q.second == kNone);
  const bool split_q = q.second != kNone && (area_q * 2 > area_p || p.second == kNone);
  if (split_p) lookInto(one);
  if (split_q) lookInto(other);
  if (split_p && split_q) {
    pair(one + 1, other + 1, out);
    pair(one + 1, q.second, out);
    pair(p.second, other + 1, out);
    pair(p.second, q.second, out);
  } else if (split_p) {
    pair(one + 1, other, out);
    pair(p.second, other, out);
  } else {
    pair(one, other + 1, out);
    pair(one, q.second, out);
  }
}

bool ClothTree::flatTogether(std::uint32_t one, std::uint32_t other) noexcept {
  const Node &p = nodes_[one], &q = nodes_[other];
  const QuadRectangle hull = hullOf(p.quads, q.quads, grid_.closed ? grid_.linkCount() : 0);
  PatchSlopes slopes = slopes_[one];
  slopes.merge(slopes_[other]);
  if (area(hull) != area(p.quads) + area(q.quads)) {
    const bool quads = p.second == kNone && q.second == kNone;
    const bool blocks = !isBelowBlock(one) && !isBelowBlock(other);
    if (quads ? !mergeQuads(hull, slopes) : !(blocks && mergeBlocks(hull, slopes))) return false;
  }
  return leastDistance(slopes, rounding_) > reach_;
}

bool ClothTree::mergeQuads(const QuadRectangle& hull, PatchSlopes& slopes) noexcept {
  if (area(hull) > kMostInHull) return false;
  const int columns = grid_.linkCount();
  for (int i = hull.row; i < hull.row_end; ++i) {
    for (int j = hull.column; j < hull.column_end; ++j) {
      const std::uint32_t node = quad_nodes_[static_cast<std::size_t>(i * columns + j % columns)];
      lookInto(node);
      slopes.merge(slopes_[node]);
    }
  }
  return true;
}

bool ClothTree::mergeBlocks(const QuadRectangle& hull, PatchSlopes& slopes) const noexcept {
  const int columns = grid_.linkCount(), across = static_cast<int>(column_bounds_.size()) - 1;
  const int row = block_row_[static_cast<std::size_t>(hull.row)];
  const int row_end = block_row_[static_cast<std::size_t>(hull.row_end) - 1] + 1;
  const int column = block_column_[static_cast<std::size_t>(hull.column)];
  const int last = hull.column_end - 1;
  const int column_end = block_column_[static_cast<std::size_t>(last % columns)] + last / columns * across + 1;
  if ((row_end - row) * (column_end - column) > kMostInHull) return false;
  for (int i = row; i < row_end; ++i) {
    for (int j = column; j < column_end; ++j) {
      slopes.merge(slopes_[blocks_[static_cast<std::size_t>(i * across + j % across)].node]);
    }
  }
  return true;
}

void ClothTree::quadSelf(std::uint32_t node, Candidates& out) noexcept {
  const QuadRectangle& at = nodes_[node].quads;
  const NearElements mine(quadElements(grid_, at.row, at.column), node_boxes_, boxes_[node], reach_);
  for (std::size_t v = 0; v < mine.vertices.count; ++v) {
    for (std::size_t t = 0; t < mine.triangles.count; ++t) {
      const MeshTriangle& triangle = mine.triangles.elements[t];
      if (isCorner(mine.vertices.elements[v], triangle)) continue;
      if (mine.vertices.boxes[v].meets(mine.triangles.boxes[t], reach_)) add(mine.vertices.elements[v], triangle, out);
    }
  }
  for (std::size_t e = 0; e < mine.edges.count; ++e) {
    for (std::size_t f = e + 1; f < mine.edges.count; ++f) {
      const MeshEdge &edge = mine.edges.elements[e], &second = mine.edges.elements[f];
      if (!shareNode(edge, second) && mine.edges.boxes[e].meets(mine.edges.boxes[f], reach_)) add(edge, second, out);
    }
  }
}

void ClothTree::quadPair(std::uint32_t one, std::uint32_t other, Candidates& out) noexcept {
  lookInto(one);
  lookInto(other);
  const QuadRectangle &p = nodes_[one].quads, &q = nodes_[other].quads;
  const NearElements first(quadElements(grid_, p.row, p.column), node_boxes_, boxes_[other], reach_);
  const NearElements second(quadElements(grid_, q.row, q.column), node_boxes_, boxes_[one], reach_);
  bool asked = false, flat = false;
  // Asked at the first pair that would be added, for most pairs of quads have none.
  const auto isFlat = [&] {
    if (!asked) flat = flatTogether(one, other);
    asked = true;
    return flat;
  };
  const auto triangles = [&](const NearElements& a, const NearElements& b) {
    for (std::size_t v = 0; v < a.vertices.count; ++v) {
      for (std::size_t t = 0; t < b.triangles.count; ++t) {
        if (!a.vertices.boxes[v].meets(b.triangles.boxes[t], reach_)) continue;
        if (isCorner(a.vertices.elements[v], b.triangles.elements[t])) continue;
        if (isFlat()) return;
        add(a.vertices.elements[v], b.triangles.elements[t], out);
      }
    }
  };
  triangles(first, second);
  if (!flat) triangles(second, first);
  for (std::size_t e = 0; e < first.edges.count && !flat; ++e) {
    for (std::size_t f = 0; f < second.edges.count; ++f) {
      if (!first.edges.boxes[e].meets(second.edges.boxes[f], reach_)) continue;
      if (shareNode(first.edges.elements[e], second.edges.elements[f])) continue;
      if (isFlat()) break;
      add(first.edges.elements[e], second.edges.elements[f], out);
    }
  }
}

void ClothTree::add(std::uint32_t vertex, const MeshTriangle& t, Candidates& out) const {
  if (immovable_[vertex] & immovable_[t[0]] & immovable_[t[1]] & immovable_[t[2]]) return;
  out.vertex_triangles.push_back({vertex, t});
}

void ClothTree::add(const MeshEdge& p, const MeshEdge& q, Candidates& out) const {
  if (immovable_[p[0]] & immovable_[p[1]] & immovable_[q[0]] & immovable_[q[1]]) return;
  out.edge_edges.push_back({p, q});
}

}  // namespace curtain
