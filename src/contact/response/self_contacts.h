// SPDX-License-Identifier: BSD-3-Clause
//
// Narrow phase and response of self-contact: pairs of a vertex and a triangle, or of two edges, of the first layer's
// mesh. The normal is the direction between the closest points at the start of the substep, so the force preserves
// momentum and angular momentum.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "cloth/cloth.h"
#include "contact/narrow_phase/element_pairs.h"
#include "step/contacts.h"

namespace curtain {

/// Two elements without a common node: vertex node[0] and triangle node[1..3], or edges node[0..1] and node[2..3].
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

/// Closest points of two elements: sum weight_k x_k is the vector from the second to the first.
struct ClosestPoints {
  std::array<double, 4> weight;
  Vec3 apart;       ///< that vector [m]
  double distance;  ///< its length [m]
  bool inside;      ///< of two edges: not at an end
};
/// edges: of 0-1 and 2-3; else of 0 and 1-2-3.
ClosestPoints closestPoints(bool edges, const std::array<Vec3, 4>& at) noexcept;

class SelfContacts {
 public:
  /// Share of the gap below which a pair counts as crossing.
  static constexpr double kMinShare = 0.02;

  /// gap: between two parts of the cloth [m]. Uses friction and recovery_speed of params.
  SelfContacts(const ClothPattern& pattern, double gap, const ContactParams& params);

  double gap() const noexcept { return gap_; }
  void limitRecovery(double most) noexcept { max_recovery_ = most; }
  void setFriction(double friction) noexcept { friction_ = friction; }

  /// Adds contacts that may touch along the motion from start to predicted, in a substep of h [s], and those that
  /// pushed in the last one (`last`), sorted by node. candidates: at least all pairs that come within the gap, in any
  /// order.
  void collect(const Candidates& candidates, const Contacts& last, const Field3& start, const Field3& predicted,
               double h, Contacts& contacts) noexcept;

  /// Adds contacts for pairs that would cross along the motion from start to end; returns how many. candidates: at
  /// least all pairs that come within kMinShare of the gap, in any order.
  int verify(const Candidates& candidates, const Field3& start, const Field3& end, double h,
             Contacts& contacts) noexcept;

  /// Calls f(pair) for every crossing pair.
  template <typename F>
  void forEachCrossing(const Candidates& candidates, const Field3& start, const Field3& end, const F& f) noexcept {
    findCrossings(candidates, start, end);
    for (const PairKey& pair : pairs_) f(pair);
  }
  /// Crossing pairs were dropped for lack of room.
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
  double max_recovery_ = std::numeric_limits<double>::infinity();  // in a substep [m]
  std::vector<PairKey> pairs_;                                     // touching or crossing
  std::vector<ClosestPoints> closest_;                             // of touching pairs, at the start
  bool full_ = false;
};

}  // namespace curtain
