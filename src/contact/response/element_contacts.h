// SPDX-License-Identifier: BSD-3-Clause
//
// Narrow phase and response of one obstacle in a substep: contacts of nodes and elements along the predicted motion,
// and crossings along the solved one. Nodes keep the thickness, from the padding where there is one. Between nodes that
// do, faces and edges get nearer than the core only where the obstacle is pointed.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "contact/broad_phase/obstacle_candidates.h"
#include "contact/response/exit_direction.h"
#include "obstacles/obstacle_set.h"
#include "scene/infinity.h"
#include "step/substep.h"

namespace curtain {

/// One obstacle in one substep.
struct ObstacleSubstep {
  const MovingObstacle& moving;
  int obstacle;  ///< index in the set
  double h;      ///< [s]
  ContactFinder::ForcesAct act;
  bool frictionless;      ///< no friction
  double recovery_speed;  ///< depenetration speed within the gap [m/s]
  double max_recovery;    ///< largest depenetration in this substep [m]

  /// Depenetration of a part at this signed distance [m].
  double recoveryAt(double distance) const noexcept;
};

/// A node or element that would cross an obstacle (CCD hit).
struct Crossing {
  std::array<std::uint32_t, 3> node{};
  int nodes = 1;
  Contact contact;  ///< that prevents it
};

/// Share of the kept distance that may be missing without recovery.
constexpr double kRestingSlack = 0.1;

/// Signed distance from the padding to require at the end of a substep [m], for a part at `distance` at its start that
/// should be at `kept`. Parts nearer than that recover by `recovery` at most, and not at all if they lack less than a
/// tenth: a resting contact must not be shaken by the residual of the solve.
double recoveredDistance(double distance, double kept, double recovery) noexcept;

/// Contacts of nodes. Refreshes the cached planes.
void collectNodes(const ObstacleSubstep& substep, const ClothPattern& pattern, ObstacleCandidates& candidates,
                  const ExitDirection& exit, const Workers& workers, Contacts& contacts) noexcept;
/// Contacts of faces and edges; there may be duplicates. Faces that start inside go to collectPenetratingFaces().
void collectFaces(const ObstacleSubstep& substep, const ClothPattern& pattern, ObstacleCandidates& candidates,
                  std::vector<PenetratingFace>& penetrating, Contacts& contacts) noexcept;
void collectPenetratingFaces(const ObstacleSubstep& substep, const ClothPattern& pattern,
                             const ObstacleCandidates& candidates, const ExitDirection& exit,
                             const std::vector<PenetratingFace>& penetrating, Contacts& contacts) noexcept;
void collectPairs(const ObstacleSubstep& substep, const ClothPattern& pattern, const ObstacleCandidates& candidates,
                  Contacts& contacts) noexcept;

/// Sets the plane of a contact of an edge or a face that is curved to that of where its nodes are now; place: of the
/// shape.
void relinearise(const ContactShape& shape, const Transform& place, const Field3& position, Contact& contact) noexcept;

/// Crossings along the motion that the candidates were found for. Parts that start inside are skipped.
void crossingNodes(const ObstacleSubstep& substep, const ClothPattern& pattern, ObstacleCandidates& candidates,
                   std::vector<Crossing>& crossings) noexcept;
void crossingFaces(const ObstacleSubstep& substep, const ClothPattern& pattern, const ObstacleCandidates& candidates,
                   std::vector<Crossing>& crossings) noexcept;
void crossingPairs(const ObstacleSubstep& substep, const ClothPattern& pattern, const ObstacleCandidates& candidates,
                   std::vector<Crossing>& crossings) noexcept;

/// A point of the cloth above a plane, in the obstacle's frame.
struct ContactPoint {
  std::array<std::uint32_t, 3> node{};
  std::array<double, 3> weight{};
  int nodes = 1;
  double share = 0.0;           ///< of the substep that has passed when it touches, [0, 1)
  Vec3 start = Vec3::Zero();    ///< position at the start of the substep [m]
  Vec3 touch = Vec3::Zero();    ///< and when it touches [m]
  Vec3 normal = Vec3::UnitZ();  ///< unit
  double height = 0.0;          ///< normal . x >= height at the end [m]
  double distance = 0.0;        ///< signed, at the start [m]; negative: no friction
  double asked = 0.0;           ///< distance at the end [m]
  bool curved = false;          ///< Contact::curved
  double recovery = 0.0;        ///< how far the point is to come out [m]
  double room = kInfinity;      ///< Contact::room

  /// Requires `kept` from the surface at the end, or recovery towards it.
  void keep(double at_start, double kept, const ObstacleSubstep& substep) noexcept {
    const double padding = substep.moving.padding;
    asked = padding + recoveredDistance(at_start - padding, kept - padding, substep.recoveryAt(at_start));
    distance = at_start;
    height += asked;
    recovery = std::max(0.0, asked - at_start);
    if (at_start > padding) room = asked - 0.5 * (at_start + padding);
  }
};
/// Converts to world frame. Nodes of weight 0 are left out; false: none of the others can move.
bool makeContact(const ObstacleSubstep& substep, const ClothPattern& pattern, const ContactPoint& point,
                 Contact& contact) noexcept;

}  // namespace curtain
