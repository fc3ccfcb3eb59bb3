// SPDX-License-Identifier: BSD-3-Clause
//
// Which elements of the moving cloth may come near each other: neighbours by windows (windows.h), all others by blocks
// (narrow_phase/separating_axis.h). What the whole cloth does together is left out first. Nothing is kept from look to
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <vector>

#include "contact/broad_phase/box_hierarchy.h"
#include "contact/broad_phase/flat_blocks.h"
#include "contact/broad_phase/hierarchy_pairs.h"
#include "contact/broad_phase/neighbour_windows.h"
#include "contact/narrow_phase/element_pairs.h"
#include "solver/workers.h"

namespace curtain {

/// Not thread-safe.
class SelfCandidates {
 public:
  /// Candidates that room is made for, per node of the cloth.
  static constexpr std::size_t kRoomPerNode = 64;

  /// Takes the grid, the rest lengths and which nodes are immovable (inverse_mass 0). At least 2 x 2 nodes. workers
  /// share the looks, and must outlive this; null: the caller is alone.
  explicit SelfCandidates(const ClothPattern& pattern, const Workers* workers = nullptr);

  /// Appends every pair (vertex, triangle) and (edge, edge) that shares no node, has a node that can move, and comes
  /// within `reach` [m, >= 0] at some time while nodes move straight from start to end (finite, of the grid's size);
  /// and some that do not, but are too near to tell. Each comes once, but for closed cloth of three or four columns.
  /// Allocates nothing: what `out` has no room for is left out, and it says so; see reserve(). Rounding
  /// only ever adds pairs.
  void collect(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept;

  /// After collect() with the same start and a larger reach: appends to its candidates what they lack of those that
  /// come within `reach` [m] while nodes move from there to end.
  void collectDeviating(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept;

  /// Makes room for kRoomPerNode candidates of either kind per node.
  void reserve(Candidates& out) const { out.reserve(kRoomPerNode * grid_.nodeCount()); }

 private:
  /// Where nodes are, and what that is relative to.
  struct Motion {
    MovingNodes nodes;
    Vec3 start = Vec3::Zero(),
         end = Vec3::Zero();  // the origins at both instants: the first node's start, the end with the mean motion [m]
    float rounding = 0.0f;    // most by which a difference of two coordinates is rounded [m]
  };

  void setMotion(const Field3& start, const Field3& end, Motion& motion) noexcept;
  std::size_t markDeviating(const Field3& end, double most) noexcept;
  void collectOf(const std::vector<std::uint8_t>* marked, const Motion& motion, double reach, Candidates& out) noexcept;
  void interleaveNodes(const MovingNodes& nodes) noexcept;

  struct QuadPair {
    std::uint32_t a, b;  // places in the hierarchy
  };
  /// Pairs of elements: the first `near` of them are near, the others have not been looked at yet.
  struct Pairs {
    std::vector<FourNodes> nodes;
    std::size_t near = 0;
    bool isFull() const noexcept { return nodes.size() == nodes.capacity(); }
  };
  /// What one of equal shares of the blocks and windows has led to.
  struct Share {
    std::vector<QuadPair> quads;  // that may be near, and wait to be looked at together
    Pairs vertices, edges;
    void clear() noexcept {
      for (Pairs* const pairs : {&vertices, &edges}) {
        pairs->nodes.clear();
        pairs->near = 0;
      }
    }
  };
  /// What is looked for.
  struct Query {
    float reach, rounding;
    bool bent;  // so are some blocks
    Candidates* out;
  };
  using QuadTest = std::uint32_t (*)(const std::array<TwoQuads, kPairsAtOnce>&, const SweptNodes&, float,
                                     float) noexcept;
  SweptNodes swept() const noexcept { return {starts_.data(), ends_.data()}; }
  void collectShare(const Query& query, int index, Share& share) const noexcept;
  void keepUnseparatedQuads(QuadTest separated, const Query& query, std::vector<QuadPair>& quads) const noexcept;
  void addElements(const Query& query, Share& share) const noexcept;
  void addVertex(const Query& query, const FourNodes& nodes, Share& share) const noexcept;
  void addEdge(const Query& query, const FourNodes& nodes, Share& share) const noexcept;
  void makeRoom(const Query& query, Share& share) const noexcept;
  static void flush(const Query& query, Share& share) noexcept;
  void discardSeparatedVertices(const Query& query, Share& share) const noexcept;
  void discardSeparatedEdges(const Query& query, Share& share) const noexcept;

  Grid grid_;
  ElementPairs elements_;
  Spacings per_spacing_;
  BoxHierarchy hierarchy_;
  std::size_t flat_level_;
  FlatBlocks flat_blocks_;  // of that level
  HierarchyPairs pairs_;
  Windows windows_;
  Motion expected_, deviating_;                // of the last collect(), of collectDeviating()
  double reach_ = 0.0;                         // of the last collect() [m]
  std::vector<std::uint8_t> marked_;           // by node: it ends deviating
  std::vector<Eigen::Array4f> starts_, ends_;  // of the motion that is looked at, one by one, by the nodes' indices
  const Workers* workers_;
  std::vector<Share> shares_;       // empty between looks
  mutable std::mutex making_room_;  // where a share has none; there is plenty
};

}  // namespace curtain
