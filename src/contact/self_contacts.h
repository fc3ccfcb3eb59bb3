// SPDX-License-Identifier: BSD-3-Clause
//
// Contact of the cloth with itself: pairs of a vertex and a triangle, or of two edges, of the first layer's mesh that may
// come near, and which of them touch in a substep. The normal of a contact is the direction between the
// closest points where the substep starts, so its force turns nothing: momentum and angular momentum are those before.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/cloth.h"
#include "contact/candidates.h"
#include "contact/pair_table.h"
#include "solver/contacts.h"

namespace curtain {

/// Two elements that share no node: vertex node[0] and triangle node[1..3], or edges node[0..1] and node[2..3].
struct NearPair {
  PairKey key;
  double push = 0.0;  ///< multipliers of the last accepted substep [kg m]
  Vec3 slide = Vec3::Zero();
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
  /// Source of a contact whose pair is near no more.
  static constexpr std::uint32_t kNoPair = PairTable::kNone;

  /// gap: kept between two parts of the cloth [m].
  SelfContacts(const ClothPattern& pattern, double gap, double friction);

  double gap() const noexcept { return gap_; }
  /// No pair was near at the last look.
  bool noneNear() const noexcept { return near_.empty(); }

  /// Takes new candidates; pairs that were near before keep their multipliers, and contacts of the present substep name the
  /// new pairs.
  void renew(const Candidates& candidates, Contacts& contacts) noexcept;
  void forget() noexcept { near_.clear(); }

  /// Adds what may touch on the way from start to predicted, in a substep of h [s].
  void collect(const Field3& start, const Field3& predicted, double h, Contacts& contacts) noexcept;

  /// Adds contacts for pairs that would go through each other on the way from start to end; returns how many.
  int verify(const Field3& start, const Field3& end, double h, Contacts& contacts) noexcept;

  /// The pairs that would; f(pair).
  template <typename F>
  void forEachCrossing(const Field3& start, const Field3& end, const F& f) const noexcept {
    for (const NearPair& pair : near_) {
      double distance = 0.0;
      if (crossesAt(pair, corners(pair, start), corners(pair, end), distance) <= 1.0) f(pair);
    }
  }

  /// Takes over the multipliers of an accepted substep.
  void remember(const Contacts& contacts) noexcept;

  void carry(Archive& archive, const Grid& grid);

 private:
  double crossesAt(const NearPair& pair, const std::array<Vec3, 4>& from, const std::array<Vec3, 4>& to,
                   double& distance) const noexcept;
  static std::array<Vec3, 4> corners(const NearPair& pair, const Field3& position) noexcept {
    return {position.at(pair.key.node[0]), position.at(pair.key.node[1]), position.at(pair.key.node[2]),
            position.at(pair.key.node[3])};
  }
  Contact makeContact(const NearPair& pair, std::uint32_t source, const ClosestPoints& closest) const noexcept;
  double offsetAt(double distance, double h) const noexcept;

  double gap_, friction_;
  std::vector<NearPair> near_;
  std::vector<NearPair> pushed_;  // pairs of the last candidates that pushed
  PairTable table_;
};

}  // namespace curtain
