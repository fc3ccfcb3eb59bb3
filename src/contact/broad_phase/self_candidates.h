// SPDX-License-Identifier: BSD-3-Clause
//
// Broad phase of self-contact: pairs of elements that may come near each other while the nodes move straight.
//
//   quads with a common node   windows of 2 x 2 quads that are not proven flat              narrow_phase/flatness.h
//   all others                 boxes of patches and of quads, then a plane between quads    patches.h
//   elements of either         a plane between them                                         separating_axis.h
//
// Elements are tested for eight clusters of nodes at a time, of a window or of two quads, whose nodes are numbered
// alike. Patches that are even as a whole, with those around them, are skipped.
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <vector>

#include "cloth/workers.h"
#include "contact/broad_phase/flat_patches.h"
#include "contact/broad_phase/patches.h"
#include "contact/broad_phase/swept_nodes.h"
#include "contact/narrow_phase/element_pairs.h"
#include "contact/narrow_phase/flatness.h"
#include "contact/narrow_phase/separating_axis.h"

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
  void pinsChanged(const ClothPattern& pattern) noexcept;

  /// Appends every pair (vertex, triangle) and (edge, edge) that has no common node, has a movable node, and comes
  /// within `reach` [m, >= 0] at some time while nodes move straight from start to end (finite, of the grid's size);
  /// also some that only nearly do, so rounding never loses a pair. Each pair comes once, except for closed cloth of
  /// three or four columns. Allocates nothing: without room in `out` for all none is named and out.full is set; see
  /// reserve().
  void collect(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept;

  /// After collect() with the same start and a larger reach: completes its candidates to all pairs that come within
  /// `reach` [m] while nodes move from start to this end. Looks only where nodes end elsewhere than collect() was told;
  /// what it names may be named already.
  void collectDeviating(const Field3& end, double reach, Candidates& out) noexcept;

  /// Gives `out` room for kRoomPerNode candidates of either kind per node.
  void reserve(Candidates& out) const { out.reserve(kRoomPerNode * grid_.nodeCount()); }

 private:
  /// Where a quad or a window can be: at the lower and at the right border they own more elements.
  static constexpr std::size_t kWhere = 4;
  /// Element pairs of a cluster: of a window, by where it is, or of two quads, by where both are.
  struct Kind {
    std::vector<LocalPair> vertices, edges;
  };
  static constexpr std::size_t kKinds = kWhere + kWhere * kWhere;
  /// What one worker has found so far.
  struct Share {
    std::vector<TwoQuads> quads;            // to be tested
    std::array<Clusters, kKinds> clusters;  // by kind, to be tested
    std::array<std::size_t, kKinds> count;  // of these
    Candidates near;
  };
  /// Parameters of one search.
  struct Query {
    StraightMotion motion;
    float most;  // patches that deviate from what was expected by no more are skipped [m]; 0: all are
    Candidates* out;
  };

  void makeKinds();
  std::size_t whereIs(int row, int column, int high, int wide) const noexcept;
  // deviation [m]: see Query::most
  void collectOf(double reach, double deviation, Candidates& out) noexcept;
  void collectShare(const Query& query, std::size_t index, Share& share) const noexcept;
  void addWindows(const Query& query, std::size_t index, Share& share) const noexcept;
  bool onlyNeighboursMeet(const Query& query) const noexcept;
  FlatNodes flatNodes(const Query& query, int row, int column) const noexcept;
  bool isWanted(const Query& query, int a, int b) const noexcept;
  void testQuads(const Query& query, Share& share) const noexcept;
  void keepUnseparated(const Query& query, int steps, std::vector<TwoQuads>& quads) const noexcept;
  void addQuads(const Query& query, TwoQuads pair, Share& share) const noexcept;
  template <typename Block>
  void forEachBlock(int count, const Block& block) const;
  template <typename NodeOf>
  void addCluster(const Query& query, std::size_t kind, const NodeOf& node_of, Share& share) const noexcept;
  void testClusters(const Query& query, std::size_t kind, Share& share) const noexcept;
  void name(const Query& query, bool edges, const std::array<std::uint32_t, 4>& nodes, Share& share) const noexcept;
  bool isCloth(bool edges, const std::array<std::uint32_t, 4>& nodes) const noexcept;
  void makeRoom(const Query& query, Share& share) const noexcept;
  static void flush(const Query& query, Share& share) noexcept;

  SweptNodes nodes_;
  Grid grid_;                            // of these: all nodes here are in it
  std::vector<std::uint32_t> in_field_;  // and where they are in a Field
  std::vector<std::uint8_t> immovable_;
  Spacings per_spacing_;
  double reach_ = 0.0;  // of the last collect() [m]
  FlatPatches flat_;
  int high_, wide_;  // quads along a window: two, or one where there are no more
  Gaps gaps_;
  Patches patches_;
  std::array<Kind, kKinds> kinds_;
  const Workers* workers_;
  std::vector<Share> shares_;       // empty between searches
  mutable std::mutex making_room_;  // for shares that run full; rare
};

}  // namespace curtain
