// SPDX-License-Identifier: BSD-3-Clause
//
// Which elements of the cloth may come near each other: down the tree, past what is flat or far apart.
#include <algorithm>
#include <limits>

#include "contact/broad_phase/cloth_tree.h"
#include "contact/narrow_phase/staying_apart.h"

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

std::size_t lowestLane(std::uint32_t lanes) { return static_cast<std::size_t>(__builtin_ctz(lanes)); }

bool isCorner(std::uint32_t vertex, const MeshTriangle& t) {
  return vertex == t[0] || vertex == t[1] || vertex == t[2];
}

}  // namespace

/// A quad that is looked at, with its elements' boxes.
struct ClothTree::OpenQuad {
  QuadElements elements;
  std::array<const ElementBoxes*, 2> boxes;  // the second may be missing
};

/// Two sets of lanes.
struct ClothTree::QuadPair {
  const OpenQuad &p, &q;
  bool p_second, q_second;
};

void ClothTree::collectSelf(double reach, Candidates& out) noexcept {
  std::fill(wanted_.begin(), wanted_.end(), std::uint8_t{1});
  collectWanted(reach, out);
}

void ClothTree::collectSelfOf(const std::vector<std::uint8_t>& marked, double reach, Candidates& out) noexcept {
  for (auto node = static_cast<std::uint32_t>(nodes_.size()); node-- > 0;) {
    if (nodes_[node].second != kNone) {
      wanted_[node] = wanted_[node + 1] | wanted_[nodes_[node].second];
      continue;
    }
    const auto corners = quadElements(grid_, nodes_[node].quads.row, nodes_[node].quads.column).corners;
    wanted_[node] = marked[corners[0]] | marked[corners[1]] | marked[corners[2]] | marked[corners[3]];
  }
  collectWanted(reach, out);
}

void ClothTree::collectWanted(double reach, Candidates& out) noexcept {
  reach_ = static_cast<float>(reach) * (1.0f + 2.0f * std::numeric_limits<float>::epsilon()) + rounding_;
  ++queries_;
  first_vertex_ = out.vertex_triangles.size();
  first_edge_ = out.edge_edges.size();
  self(0, out);
  dropApart(out);
}

// Of long quads boxes along the axes meet by the thousand, of which few come near.
void ClothTree::makeRoom(Candidates& out) noexcept {
  constexpr std::size_t kMostOfTwoQuads = 32;
  if (std::max(out.vertex_triangles.size(), out.edge_edges.size()) + kMostOfTwoQuads > out.room) dropApart(out);
}

// Boxes along the axes let through many times the pairs that come near.
void ClothTree::dropApart(Candidates& out) noexcept {
  const auto filter = [&](auto& pairs, std::size_t& first, const auto& stay_apart) {
    std::size_t kept = first;
    for (std::size_t from = first; from < pairs.size(); from += 4) {
      const std::size_t count = std::min<std::size_t>(4, pairs.size() - from);
      std::array<FourNodes, 4> four;
      for (std::size_t k = 0; k < 4; ++k) four[k] = nodesOf(pairs[from + std::min(k, count - 1)]);
      const std::uint32_t apart = stay_apart(four, ways_.data(), reach_, rounding_);
      for (std::size_t k = 0; k < count; ++k) {
        pairs[kept] = pairs[from + k];
        kept += (apart >> k & 1U) == 0 ? 1 : 0;
      }
    }
    pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(kept), pairs.end());
    first = kept;
  };
  filter(out.vertex_triangles, first_vertex_, vertexStaysApart);
  filter(out.edge_edges, first_edge_, edgesStayApart);
}

void ClothTree::self(std::uint32_t node, Candidates& out) noexcept {
  if (wanted_[node] == 0 || isFlatBeyond(reach_, slopes_[node], rounding_)) return;
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
  if ((wanted_[one] | wanted_[other]) == 0 || !boxes_[one].meets(boxes_[other], reach_)) return;
  const Node &p = nodes_[one], &q = nodes_[other];
  if (p.second == kNone && q.second == kNone) {
    quadPair(one, other, out);
    return;
  }
  // Below blocks few that do not make up a rectangle are flat together; their quads' windows are asked.
  const bool is_rectangle = area(hullOf(p.quads, q.quads, 0)) == area(p.quads) + area(q.quads);
  if ((is_rectangle || !(isBelowBlock(one) || isBelowBlock(other))) && flatTogether(one, other)) return;
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
  PatchSlopes slopes;
  if (area(hull) == area(p.quads) + area(q.quads)) {
    slopes = slopes_[one];
    slopes.merge(slopes_[other]);
  } else if (p.second == kNone && q.second == kNone) {
    if (!mergeQuads(hull, slopes)) return false;
  } else if (isBelowBlock(one) || isBelowBlock(other) || !mergeBlocks(hull, slopes)) {
    return false;
  }
  return isFlatBeyond(reach_, slopes, rounding_);
}

bool ClothTree::mergeQuads(const QuadRectangle& hull, PatchSlopes& slopes) noexcept {
  if (area(hull) > kMostInHull) return false;
  const int columns = grid_.linkCount();
  const auto at = [&](int i, int j) { return quad_nodes_[static_cast<std::size_t>(i * columns + j % columns)]; };
  lookInto(at(hull.row, hull.column));
  slopes = slopes_[at(hull.row, hull.column)];
  for (int i = hull.row; i < hull.row_end; ++i) {
    for (int j = hull.column; j < hull.column_end; ++j) {
      lookInto(at(i, j));
      slopes.merge(slopes_[at(i, j)]);
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
  const auto at = [&](int i, int j) { return blocks_[static_cast<std::size_t>(i * across + j % across)].node; };
  slopes = slopes_[at(row, column)];
  for (int i = row; i < row_end; ++i) {
    for (int j = column; j < column_end; ++j) {
      slopes.merge(slopes_[at(i, j)]);
    }
  }
  return true;
}

const QuadWays& ClothTree::quadWays(std::uint32_t node) noexcept {
  const QuadRectangle& at = nodes_[node].quads;
  const auto quad = static_cast<std::size_t>(at.row * grid_.linkCount() + at.column);
  if (quad_refits_[quad] != refits_) {
    quad_refits_[quad] = refits_;
    lookInto(node);
    quad_ways_[quad].fill(quadElements(grid_, at.row, at.column).corners, ways_);
  }
  return quad_ways_[quad];
}

ClothTree::OpenQuad ClothTree::openQuad(std::uint32_t node) noexcept {
  lookInto(node);
  const QuadRectangle& at = nodes_[node].quads;
  const auto quad = static_cast<std::size_t>(at.row * grid_.linkCount() + at.column);
  OpenQuad open{quadElements(grid_, at.row, at.column), {&element_boxes_[quad], nullptr}};
  const bool has_second = open.elements.vertex_count > 2;  // one quad at most: it lies behind the last
  if (element_refits_[quad] != refits_) {
    element_refits_[quad] = refits_;
    element_boxes_[quad].fill(open.elements, false, ways_);
    if (has_second) element_boxes_.back().fill(open.elements, true, ways_);
  }
  if (has_second) open.boxes[1] = &element_boxes_.back();
  return open;
}

void ClothTree::quadSelf(std::uint32_t node, Candidates& out) noexcept {
  if (inFlatWindow(nodes_[node].quads, nodes_[node].quads) == InWindow::kFlat) return;
  makeRoom(out);
  const OpenQuad quad = openQuad(node);
  const auto never = [] { return false; };  // flat: has been asked
  for (const bool second : {false, true}) {
    if (quad.boxes[second] == nullptr) continue;
    for (std::size_t lane = 0; lane < 8; ++lane) {
      const std::uint32_t later = ~0U << (lane + 1);
      addLanes({quad, quad, second, second}, lane, later, never, out);
      if (!second && quad.boxes[1] != nullptr) addLanes({quad, quad, false, true}, lane, ~0U, never, out);
    }
  }
}

void ClothTree::quadPair(std::uint32_t one, std::uint32_t other, Candidates& out) noexcept {
  const InWindow window = inFlatWindow(nodes_[one].quads, nodes_[other].quads);
  if (window == InWindow::kFlat) return;
  if (window == InWindow::kNone && quadWays(one).staysApart(quadWays(other), reach_, rounding_)) return;
  makeRoom(out);
  const OpenQuad p = openQuad(one), q = openQuad(other);
  // Boxes of slopes are for neighbours that no window holds: around the seam, and in cloth of a single row or column.
  // Asked at the first pair that would be added, for most pairs of quads have none.
  const QuadRectangle hull = hullOf(nodes_[one].quads, nodes_[other].quads, grid_.closed ? grid_.linkCount() : 0);
  bool asked = window == InWindow::kBent || area(hull) > 4, flat = false;
  const auto is_flat = [&] {
    if (!asked) flat = flatTogether(one, other);
    asked = true;
    return flat;
  };
  for (const bool p_second : {false, true}) {
    for (const bool q_second : {false, true}) {
      if (p.boxes[p_second] == nullptr || q.boxes[q_second] == nullptr) continue;
      const std::uint32_t near_q = q.boxes[q_second]->meeting(boxes_[one], reach_);
      if (near_q == 0) continue;
      std::uint32_t near_p = p.boxes[p_second]->meeting(boxes_[other], reach_);
      for (; near_p != 0 && !flat; near_p &= near_p - 1) {
        addLanes({p, q, p_second, q_second}, lowestLane(near_p), near_q, is_flat, out);
      }
    }
  }
}

template <typename IsFlat>
void ClothTree::addLanes(const QuadPair& pair, std::size_t lane, std::uint32_t others, const IsFlat& is_flat,
                         Candidates& out) const {
  const std::uint32_t bit = 1U << lane;
  others &= (bit & ElementBoxes::kEdges) != 0      ? ElementBoxes::kEdges
            : (bit & ElementBoxes::kVertices) != 0 ? ElementBoxes::kTriangles
                                                   : ElementBoxes::kVertices;
  if (others == 0) return;
  others &= pair.q.boxes[pair.q_second]->meeting(*pair.p.boxes[pair.p_second], lane, reach_);
  const QuadElements &p = pair.p.elements, &q = pair.q.elements;
  for (; others != 0; others &= others - 1) {
    const std::size_t other = lowestLane(others);
    if ((bit & ElementBoxes::kEdges) != 0) {
      const MeshEdge& first = ElementBoxes::edge(p, pair.p_second, lane);
      const MeshEdge& second = ElementBoxes::edge(q, pair.q_second, other);
      if (shareNode(first, second) || isImmovable(first, second)) continue;
      if (is_flat()) return;
      out.add(EdgeEdge{first, second});
    } else {
      const bool vertex_first = (bit & ElementBoxes::kVertices) != 0;
      const std::uint32_t vertex =
          vertex_first ? ElementBoxes::vertex(p, pair.p_second, lane) : ElementBoxes::vertex(q, pair.q_second, other);
      const MeshTriangle& triangle = vertex_first ? ElementBoxes::triangle(q, other) : ElementBoxes::triangle(p, lane);
      if (isCorner(vertex, triangle) || isImmovable(vertex, triangle)) continue;
      if (is_flat()) return;
      out.add(VertexTriangle{vertex, triangle});
    }
  }
}

}  // namespace curtain
