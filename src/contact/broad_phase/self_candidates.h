// SPDX-License-Identifier: BSD-3-Clause
//
// Broad phase of self-contact: pairs of elements that may come near each other while the nodes move straight. Quads
// with a common node go through neighbour_windows.h; all others through the box hierarchy (hierarchy_pairs.h), then
// quads and then elements through separating axis tests (narrow_phase/separating_axis.h). Regions that are proven flat
// are skipped (flat_blocks.h). Positions are taken relative to the mean motion of the cloth. Nothing is cached between
// calls.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <vector>

#include "cloth/workers.h"
#include "contact/broad_phase/box_hierarchy.h"
#include "contact/broad_phase/flat_blocks.h"
#include "contact/broad_phase/hierarchy_pairs.h"
#include "contact/broad_phase/neighbour_windows.h"
#include "contact/narrow_phase/element_pairs.h"

namespace curtain {

/// Not thread-safe.
class SelfCandidates {
 public:
  /// Capacity for candidates of either kind, per node of the cloth.
  static constexpr std::size_t kRoomPerNode = 64;

  /// Uses of the pattern the grid, the rest lengths and which nodes are immovable (inverse_mass 0); at least 2 x 2
  /// nodes. workers share the search and must outlive this; null: single-threaded.
  explicit SelfCandidates(const ClothPattern& pattern, const Workers* workers = nullptr);

  /// Which nodes can't move has changed.
  void takePins(const ClothPattern& pattern) noexcept { elements_.takePins(pattern); }

  /// Appends every pair (vertex, triangle) and (edge, edge) that has no common node, has a movable node, and comes
  /// within `reach` [m, >= 0] at some time while nodes move straight from start to end (finite, of the grid's size);
  /// also some that only nearly do, so rounding never loses a pair. Each pair comes once, except for closed cloth of
  /// three or four columns. Allocates nothing: without room in `out` pairs are dropped and out.full is set; see
  /// reserve().
  void collect(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept;

  /// After collect() with the same start and a larger reach: completes its candidates to all pairs that come within
  /// `reach` [m] while nodes move from start to this end. Searches only around nodes that end elsewhere than collect()
  /// expected.
  void collectDeviating(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept;

  /// Gives `out` room for kRoomPerNode candidates of either kind per node.
  void reserve(Candidates& out) const { out.reserve(kRoomPerNode * grid_.nodeCount()); }

 private:
  /// A motion of the nodes, and the origins it is relative to.
  struct Motion {
    MovingNodes nodes;
    Vec3 start = Vec3::Zero(),
         end =
             Vec3::Zero();  // origin at either instant: the first node's start, and that plus the mean displacement [m]
    float rounding = 0.0f;  // largest rounding error of a difference of two coordinates [m]
  };

  void setMotion(const Field3& start, const Field3& end, Motion& motion) noexcept;
  std::size_t markDeviating(const Field3& end, double most) noexcept;
  void collectOf(const std::vector<std::uint8_t>* marked, const Motion& motion, double reach, Candidates& out) noexcept;
  void interleaveNodes(const MovingNodes& nodes) noexcept;

  struct QuadPair {
    std::uint32_t a, b;  // indices in the hierarchy
  };
  /// Pairs of elements: the first `near` passed the separating axis test, the others are still to be tested.
  struct Pairs {
    decltype(&vertexSeparated) separated;
    std::vector<FourNodes> nodes{};
    std::size_t near = 0;
    bool isFull() const noexcept { return nodes.size() == nodes.capacity(); }
  };
  /// Result of one worker's share of blocks and windows.
  struct Share {
    std::vector<QuadPair> quads;  // to be tested, many at once
    Pairs vertices{vertexSeparated}, edges{edgesSeparated};
    void clear() noexcept {
      for (Pairs* const pairs : {&vertices, &edges}) {
        pairs->nodes.clear();
        pairs->near = 0;
      }
    }
  };
  /// Parameters of one search.
  struct Query {
    float reach, rounding;
    bool bent;  // some blocks are not proven flat
    Candidates* out;
  };
  SweptNodes swept() const noexcept { return {starts_.data(), ends_.data()}; }
  void collectShare(const Query& query, int index, Share& share) const noexcept;
  void keepUnseparatedQuads(decltype(&quadsSeparated) separated, const Query& query,
                            std::vector<QuadPair>& quads) const noexcept;
  void addElements(const Query& query, Share& share) const noexcept;
  void add(const Query& query, const FourNodes& nodes, Pairs& pairs, Share& share) const noexcept {
    if (pairs.isFull()) makeRoom(query, pairs, share);
    pairs.nodes.push_back(nodes);
  }
  void makeRoom(const Query& query, Pairs& pairs, Share& share) const noexcept;
  static void flush(const Query& query, Share& share) noexcept;
  void discardSeparated(const Query& query, Pairs& pairs) const noexcept;

  Grid grid_;
  ElementPairs elements_;
  Spacings per_spacing_;
  BoxHierarchy hierarchy_;
  std::size_t flat_level_;
  FlatBlocks flat_blocks_;  // of flat_level_
  HierarchyPairs pairs_;
  Windows windows_;
  Motion expected_, deviating_;                // of the last collect(); of the last collectDeviating()
  double reach_ = 0.0;                         // of the last collect() [m]
  std::vector<std::uint8_t> marked_;           // by node: it ends elsewhere than collect() expected
  std::vector<Eigen::Array4f> starts_, ends_;  // of the current motion, interleaved (x, y, z, 0), by node
  const Workers* workers_;
  std::vector<Share> shares_;       // empty between searches
  mutable std::mutex making_room_;  // for shares that run full; rare
};

}  // namespace curtain
