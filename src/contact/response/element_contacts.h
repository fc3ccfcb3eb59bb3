// SPDX-License-Identifier: BSD-3-Clause
//
// Contacts of the cloth with one obstacle in a substep: which nodes and elements touch on the expected way, and which
// would go through it on the solved one. Nodes keep the thickness; faces and edges, between nodes that do, only come
// nearer than the core where the obstacle is pointed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "contact/broad_phase/obstacle_candidates.h"
#include "contact/response/exit_direction.h"
#include "contact/shapes/obstacle_set.h"
#include "solver/contacts.h"

namespace curtain {

/// A substep of one obstacle.
struct ObstacleSubstep {
  const MovingObstacle& moving;
  int obstacle;           ///< its index
  double h;               ///< [s]
  bool frictionless;      ///< contacts are without friction
  double recovery_speed;  ///< out of the gap [m/s]
  double most_recovery;   ///< in this substep [m]
};

/// A part of the cloth that would go through an obstacle.
struct Crossing {
  std::array<std::uint32_t, 3> node{};
  int nodes = 1;
  Contact contact;  ///< that would hold it
};

/// Signed distance to ask for at the end of a substep from one of `distance` at its start, where `kept` is to be kept
/// [m]: what is nearer comes out slowly, and not at all when it lacks less than a tenth: a contact at rest must not be
/// shaken.
double recoveredDistance(double distance, double kept, const ObstacleSubstep& substep) noexcept;

/// Contacts of nodes that touch on their way. Refreshes the vicinity's planes.
void collectNodes(const ObstacleSubstep& substep, const ClothPattern& pattern, ObstacleCandidates& candidates,
                  const ExitDirection& exit, Contacts& contacts) noexcept;
/// Of faces and edges. Several may be alike. Faces that start inside are left to collectPenetratingFaces().
void collectFaces(const ObstacleSubstep& substep, const ClothPattern& pattern, ObstacleCandidates& candidates,
                  std::vector<PenetratingFace>& penetrating, Contacts& contacts) noexcept;
void collectPenetratingFaces(const ObstacleSubstep& substep, const ClothPattern& pattern,
                             const ObstacleCandidates& candidates, const ExitDirection& exit,
                             const std::vector<PenetratingFace>& penetrating, Contacts& contacts) noexcept;
void collectPairs(const ObstacleSubstep& substep, const ClothPattern& pattern, const ObstacleCandidates& candidates,
                  Contacts& contacts) noexcept;

/// What would go through on the way that the vicinity followed. Parts that are through where it starts are not.
void crossingNodes(const ObstacleSubstep& substep, const ClothPattern& pattern, ObstacleCandidates& candidates,
                   std::vector<Crossing>& crossings) noexcept;
void crossingFaces(const ObstacleSubstep& substep, const ClothPattern& pattern, const ObstacleCandidates& candidates,
                   std::vector<Crossing>& crossings) noexcept;
void crossingPairs(const ObstacleSubstep& substep, const ClothPattern& pattern, const ObstacleCandidates& candidates,
                   std::vector<Crossing>& crossings) noexcept;

/// A mixture of nodes that is held over a plane, in the obstacle's frame.
struct ContactPoint {
  std::array<std::uint32_t, 3> node{};
  std::array<double, 3> weight{};
  int nodes = 1;
  Vec3 start = Vec3::Zero();    ///< the mixture where the substep starts [m]
  Vec3 normal = Vec3::UnitZ();  ///< unit
  double height = 0.0;          ///< normal . x >= height at the end [m]
  double distance = 0.0;        ///< signed, where the substep starts [m]; negative: no friction
  double recovery = 0.0;        ///< of the height, asked of what starts inside to come out [m]

  /// Asks what is `distance` away at the start to keep `kept`, or to come out towards it.
  void keep(double at_start, double kept, const ObstacleSubstep& substep) noexcept {
    const double asked = recoveredDistance(at_start, kept, substep);
    distance = at_start;
    height += asked;
    recovery = at_start < 0.0 ? asked - at_start : 0.0;
  }
};
/// The contact in the world. Nodes without weight are left out; false: none of the others can move.
bool makeContact(const ObstacleSubstep& substep, const ClothPattern& pattern, const ContactPoint& point,
                 Contact& contact) noexcept;

}  // namespace curtain
