// SPDX-License-Identifier: BSD-3-Clause
//
// Pairs of the cloth's elements that may come near each other, looked for again and again: what one descent of the tree
// names within more than the reach is kept, and holds until too many nodes stray too far from their expected ways.
//
// A descent is of the straight ways a + t w, t in [0, 1], and of the reach with twice a leeway. Later ways from p to q
// are held against it at two times t, u that fit them best: where no node's p is further than the leeway from a + t w,
// and no q from a + u w, so it is at all times between, for both are straight; no distance is shorter by more than twice
// the leeway then. Pairs of the few nodes that stray further are looked for at every look. It is of no account which t and u are taken, nor which ways the descent is of: these only decide on
// how long it lasts.
#pragma once

#include <vector>

#include "contact/broad_phase/cloth_tree.h"

namespace curtain {

/// Not thread-safe.
class KeptPairs {
 public:
  /// See ClothTree.
  explicit KeptPairs(const ClothPattern& pattern);

  /// Appends what ClothTree::collectSelf() promises, of nodes that move straight from start to end, finite and of the
  /// grid's size; `reach` [m, >= 0]. The order depends on earlier calls, and so do pairs further apart than `reach`: who takes
  /// them must not let it tell. Allocates nothing: `out` says when it has no room; see reserve().
  void collect(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept;

  /// Appends what ClothTree::collectSelfOf() promises.
  void collectOf(const std::vector<std::uint8_t>& marked, const Field3& start, const Field3& end, double reach, Candidates& out) noexcept {
    tree_.refit(start, end);
    tree_.collectSelfOf(marked, reach, out);
  }

  void reserve(Candidates& out) const { tree_.reserve(out); }

  /// As after construction.
  void forget() noexcept;

  /// How often the tree was descended.
  long descents() const noexcept { return descents_; }

 private:
  void descend(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept;
  void appendNear(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept;
  void fillWays(const Field3& start, const Field3& end) noexcept;
  void appendOfMarked(const Field3& start, const Field3& end, double reach, Candidates& out) noexcept;
  void raiseStrays(const Field3& position) noexcept;
  std::size_t mostMarked() const noexcept;
  std::size_t mark(double more) noexcept;
  double mostStray() const noexcept;
  double commonStray(double reach) noexcept;
  bool hasMarked(const std::array<std::uint32_t, 4>& nodes) const noexcept {
    return (marked_[nodes[0]] | marked_[nodes[1]] | marked_[nodes[2]] | marked_[nodes[3]]) != 0;
  }
  double leewayFor(double reach) const noexcept;

  Grid grid_;
  ClothTree tree_;
  Candidates kept_;
  Field3 from_, way_, far_;  // [m] of the descent: a, w, a + w
  double reach_ = 0.0;       // that the kept pairs were made for [m]
  double leeway_ = 0.0;      // [m]
  double stray_ = 0.0;       // that is expected from one look to the next [m]
  int age_ = 0;              // looks since the descent
  bool expects_ = false;     // there is a descent that straying is measured from
  long descents_ = 0;
  std::vector<double> strays_;        // of nodes, squared [m^2]
  std::vector<std::uint8_t> marked_;  // of nodes: strayed further than the leeway
  std::vector<NodeWay> ways_;
  Vec3 origin_ = Vec3::Zero();  // of ways_ [m]
  float rounding_ = 0.0f;       // of ways_, see ClothTree [m]
};

}  // namespace curtain
