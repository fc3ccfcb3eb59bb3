// SPDX-License-Identifier: BSD-3-Clause
//
// Contact of the cloth with itself: pairs of a vertex and a triangle, or of two edges, of the first layer's mesh that
// may come near, and which of them touch in a substep. The normal of a contact is the direction between the
// closest points where the substep starts, so its force turns nothing: momentum and angular momentum are those before.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "cloth/cloth.h"
#include "contact/narrow_phase/element_pairs.h"
#include "solver/contacts.h"

namespace curtain {

/// Two elements that share no node: vertex node[0] and triangle node[1..3], or edges node[0..1] and node[2..3].
struct PairKey {
  std::array<std::uint32_t, 4> node;
  bool edges;
  bool operator==(const PairKey& other) const noexcept { return node == other.node && edges == other.edges; }
  bool operator<(const PairKey& other) const noexcept {
    for (std::size_t k = 0; k < 4; ++k) {
      if (node[k] != other.node[k]) return node[k] < other.node[k];
    }
    return edges < other.edges;
  }
};

/// Where two elements are closest: sum weight_k x_k is the way from the second to the first there.
struct ClosestPoints {
  std::array<double, 4> weight;
  Vec3 apart;       ///< that way [m]
  double distance;  ///< its length [m]
  bool inside;      ///< not at the end of an edge (of two edges)
};
/// edges: of 0-1 and 2-3; else of 0 and 1-2-3.
ClosestPoints closestPoints(bool edges, const std::array<Vec3, 4>& at) noexcept;

class SelfContacts {
 public:
  /// Never nearer than this share of the gap, on the whole way.
  static constexpr double kLeastShare = 0.02;

  /// gap: kept between two parts of the cloth [m]. Of params friction and recovery_speed.
  SelfContacts(const ClothPattern& pattern, double gap, const ContactParams& params);

  double gap() const noexcept { return gap_; }
  void limitRecovery(double most) noexcept { most_recovery_ = most; }

  /// Adds what may touch on the way from start to predicted, in a substep of h [s], and what pushed in the last one
  /// (`last`), in the order of their nodes. candidates: all pairs that come within the gap on that way, and any others,
  /// in any order.
  void collect(const Candidates& candidates, const Contacts& last, const Field3& start, const Field3& predicted,
               double h, Contacts& contacts) noexcept;

  /// Adds contacts for pairs that would go through each other on the way from start to end; returns how many.
  /// candidates: all pairs that come within the least share of the gap on that way, and any others, in any order.
  int verify(const Candidates& candidates, const Field3& start, const Field3& end, double h,
             Contacts& contacts) noexcept;

  /// The pairs that would; f(pair).
  template <typename F>
  void forEachCrossing(const Candidates& candidates, const Field3& start, const Field3& end, const F& f) noexcept {
    findCrossings(candidates, start, end);
    for (const PairKey& pair : pairs_) f(pair);
  }
  /// There was no room for all that cross.
  bool full() const noexcept { return full_; }

 private:
  bool touches(const PairKey& key, const Field3& start, const Field3& predicted) const noexcept;
  double crossesAt(const PairKey& key, const std::array<Vec3, 4>& from, const std::array<Vec3, 4>& to,
                   double& distance) const noexcept;
  void findCrossings(const Candidates& candidates, const Field3& start, const Field3& end) noexcept;
  template <typename Wanted>
  void select(const Candidates& candidates, const Wanted& wanted) noexcept;
  void sortPairs() noexcept;
  bool isRedundant(std::size_t pair) const noexcept;
  static std::array<Vec3, 4> corners(const PairKey& key, const Field3& position) noexcept {
    return {position.at(key.node[0]), position.at(key.node[1]), position.at(key.node[2]), position.at(key.node[3])};
  }
  Contact makeContact(const PairKey& key, const ClosestPoints& closest) const noexcept;
  double offsetAt(double distance, double h) const noexcept;

  double gap_, friction_, recovery_speed_;
  double most_recovery_ = std::numeric_limits<double>::infinity();  // in a substep [m]
  std::vector<PairKey> pairs_;                                      // that touch or cross
  std::vector<ClosestPoints> closest_;                              // of those that touch, where the substep starts
  bool full_ = false;
};

}  // namespace curtain
