// SPDX-License-Identifier: BSD-3-Clause
//
// Which parts of the moving cloth may come near each other: a binary tree over rectangles of quads,
// built once and refitted to every motion. A rectangle that is flat enough (contact/narrow_phase/flatness.h) is not looked into; single
// quads that planes part (contact/broad_phase/quad_ways.h), neighbours in a window of 2 x 2 quads that is flat, and elements that stay
// apart (contact/narrow_phase/staying_apart.h) are left out.
//
// The tree's lower levels are those within blocks of up to kBlock x kBlock quads. A refit makes the boxes and slopes
// of whole blocks, from sums over rows that vectorise; what lies below is made at the first look into a block.
//
//        rectangles of blocks          refitted always
//          /              |
//        block          block          refitted always
//        /   |          /   |
//      ...   ...      ...   ...        filled on demand, down to single quads
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"
#include "cloth/coarse_mesh.h"
#include "contact/broad_phase/quad_ways.h"
#include "contact/narrow_phase/candidates.h"
#include "contact/narrow_phase/element_boxes.h"
#include "contact/narrow_phase/flatness.h"

namespace curtain {

/// Quads of rows [row, row_end) and columns [column, column_end).
struct QuadRectangle {
  int row, row_end, column, column_end;
};

/// Not thread-safe: every call may fill in lower levels.
class ClothTree {
 public:
  /// Candidates that room is made for, per node of the cloth.
  static constexpr std::size_t kRoomPerNode = 64;

  /// Takes the grid, the rest lengths and which nodes are immovable (inverse_mass 0). At least 2 x 2 nodes.
  explicit ClothTree(const ClothPattern& pattern);

  /// Fits the tree to nodes that move straight from start to end [m], finite and of the grid's size; both are copied.
  /// Coordinates are kept in single precision relative to the first node. Allocates nothing.
  void refit(const Field3& start, const Field3& end) noexcept;

  /// Appends, once each, every pair (vertex, triangle) and (edge, edge) that shares no node, has a node that can move, and
  /// comes within `reach` [m, >= 0] at some time between start and end; and some that do not, but are too near to tell.
  /// Allocates nothing: what `out` has no room for is left out, and it says so; see reserve().
  /// Rounding only ever adds pairs.
  void collectSelf(double reach, Candidates& out) noexcept;

  /// The same of pairs that have a node that is marked (not 0; of the grid's size), and of some that have none.
  void collectSelfOf(const std::vector<std::uint8_t>& marked, double reach, Candidates& out) noexcept;

  /// Most by which a difference is rounded of two coordinates that were brought to single precision relative to `origin`
  /// [m], and are of no larger magnitude than `largest` [m] then.
  static float roundingOf(float largest, const Vec3& origin) noexcept;

  /// Makes room for kRoomPerNode candidates of either kind per node.
  void reserve(Candidates& out) const { out.reserve(kRoomPerNode * grid_.nodeCount()); }

 private:
  using Floats = std::vector<float, CacheAligned<float>>;

  static constexpr int kBlock = 8;  // most quads of a block along either side
  static constexpr std::uint32_t kNone = ~0u;

  struct Node {
    QuadRectangle quads;
    std::uint32_t second;  // of two children, the first is the next node; kNone: a single quad
    std::uint32_t block;   // that this node lies in or is the root of; kNone: it lies above blocks
    std::uint32_t end;     // one beyond the last node below
  };
  struct Block {
    std::uint32_t node;
    bool filled;
  };
  struct OpenQuad;
  struct QuadPair;

  std::uint32_t split(const QuadRectangle& quads, std::uint32_t block);
  void copyPositions(const Field3& start, const Field3& end) noexcept;
  void refitStrip(std::size_t strip) noexcept;
  void fillBlock(std::uint32_t root) noexcept;
  void fillQuad(std::uint32_t node, const Eigen::Array4f* start, const Eigen::Array4f* end) noexcept;
  void mergeChildren(std::uint32_t node) noexcept;

  bool isBelowBlock(std::uint32_t node) const noexcept {
    return nodes_[node].block != kNone && blocks_[nodes_[node].block].node != node;
  }
  // Makes sure that what lies below a node is up to date.
  void lookInto(std::uint32_t node) noexcept {
    const std::uint32_t block = nodes_[node].block;
    if (block == kNone || blocks_[block].filled) return;
    fillBlock(blocks_[block].node);
    blocks_[block].filled = true;
  }

  void collectWanted(double reach, Candidates& out) noexcept;
  void self(std::uint32_t node, Candidates& out) noexcept;
  void pair(std::uint32_t one, std::uint32_t other, Candidates& out) noexcept;
  void quadSelf(std::uint32_t node, Candidates& out) noexcept;
  void quadPair(std::uint32_t one, std::uint32_t other, Candidates& out) noexcept;
  void makeRoom(Candidates& out) noexcept;
  void dropApart(Candidates& out) noexcept;
  bool flatTogether(std::uint32_t one, std::uint32_t other) noexcept;
  enum class InWindow { kNone, kBent, kFlat };
  InWindow inFlatWindow(const QuadRectangle& one, const QuadRectangle& other) noexcept;
  bool isWindowFlat(int row, int column) noexcept;
  std::uint32_t flatWindows(std::size_t row, std::size_t column) const noexcept;
  bool mergeQuads(const QuadRectangle& hull, PatchSlopes& slopes) noexcept;
  bool mergeBlocks(const QuadRectangle& hull, PatchSlopes& slopes) const noexcept;
  const QuadWays& quadWays(std::uint32_t node) noexcept;
  OpenQuad openQuad(std::uint32_t node) noexcept;
  template <typename IsFlat>
  void addLanes(const QuadPair& pair, std::size_t lane, std::uint32_t others, const IsFlat& is_flat,
                Candidates& out) const;
  bool isImmovable(std::uint32_t vertex, const MeshTriangle& t) const noexcept {
    return (immovable_[vertex] & immovable_[t[0]] & immovable_[t[1]] & immovable_[t[2]]) != 0;
  }
  bool isImmovable(const MeshEdge& p, const MeshEdge& q) const noexcept {
    return (immovable_[p[0]] & immovable_[p[1]] & immovable_[q[0]] & immovable_[q[1]]) != 0;
  }

  Grid grid_;
  std::vector<std::uint8_t> immovable_;          // of nodes
  std::vector<int> row_bounds_, column_bounds_;  // of blocks, in quads
  std::vector<int> block_row_, block_column_;    // of a row or column of quads
  Floats per_spacing_u_, per_spacing_v_;         // [1/m] of columns, of rows of quads

  std::vector<Node> nodes_;                // parents before children, the first child next to its parent
  std::vector<std::uint32_t> upper_;       // nodes above blocks, children before parents
  std::vector<Block> blocks_;              // row by row
  std::vector<std::uint32_t> quad_nodes_;  // the leaf of a quad

  std::size_t stride_ = 0;             // of the copied positions; closed cloth has its first column once more
  std::array<Floats, 3> start_, end_;  // [m] from origin_
  std::array<Floats, 18> columns_;     // of a strip: low and high of box, u, v along x, y, z
  Vec3 origin_ = Vec3::Zero();         // [m]
  float rounding_ = 0.0f;              // most by which a difference of two copied coordinates is rounded [m]
  float reach_ = 0.0f;                 // of the query, rounding included [m]

  std::vector<FloatBox> boxes_;       // of tree nodes
  std::vector<PatchSlopes> slopes_;   // of tree nodes
  std::vector<NodeWay> ways_;         // of the cloth's nodes, in blocks that are filled
  std::vector<std::uint8_t> wanted_;  // of tree nodes: pairs of this one with any are looked for
  std::uint32_t refits_ = 0;
  std::vector<std::uint32_t> element_refits_;  // of quads: the refit that the boxes of their elements are of
  std::vector<ElementBoxes> element_boxes_;    // of quads, and the second set of the last one
  std::vector<std::uint32_t> quad_refits_;     // of quads: the refit that their ways are of
  std::vector<QuadWays> quad_ways_;
  std::size_t first_vertex_ = 0, first_edge_ = 0;  // of the candidates whose elements may yet be proved to stay apart
  std::uint32_t queries_ = 0;
  std::size_t window_groups_ = 0;              // of four windows of 2 x 2 quads, in a row of them
  std::vector<std::uint32_t> window_queries_;  // of groups: the query that windows_flat_ is of
  std::vector<std::uint8_t> windows_flat_;     // of groups: bits
};

}  // namespace curtain
