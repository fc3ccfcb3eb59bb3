// SPDX-License-Identifier: BSD-3-Clause
//
// Contact of the cloth with obstacles: parts that may touch within the substep are held above planes, tangent to the
// obstacle and a thickness away, with Coulomb friction against the moving surface; inelastic. Parts that would cross on
// the solved motion get planes where they enter; as a last resort they move with the obstacle.
//
//   box around a few nodes         rejects far obstacles, by their boxes of the frame, at next to no cost
//   box around all nodes           rejects most others
//   obstacle_candidates.h          broad phase
//   element_contacts.h             narrow phase and response for the candidates
#pragma once

#include <limits>
#include <vector>

#include "cloth/link_ways.h"
#include "contact/broad_phase/obstacle_candidates.h"
#include "contact/response/element_contacts.h"
#include "contact/response/pads.h"
#include "curtain_sim/statistics.h"
#include "obstacles/obstacle_set.h"
#include "step/contacts.h"
#include "step/substep.h"

namespace curtain {

/// Whether an obstacle can touch the cloth.
enum class ObstacleStanding { kAbsent, kFar, kNear };

class ObstacleContacts {
 public:
  /// Contacts that there is room for, per node: more make a substep allocate.
  static constexpr std::size_t kRoomPerNode = 8;

  /// Uses thickness and recovery_speed of params; pattern, obstacles and workers must outlive this.
  ObstacleContacts(const ClothPattern& pattern, const ContactParams& params, ObstacleSet& obstacles,
                   const Workers& workers);

  struct Begin {
    double h;                      ///< of the substep [s]
    ContactFinder::ForcesAct act;  ///< where its forces' normals are taken
    bool frictionless;             ///< all contacts without friction
  };
  /// Begins a substep: adds what may touch along the motion from start to predicted, sorted by the obstacles' names,
  /// the contacts' nodes and features.
  void begin(const Field3& start, const Field3& predicted, const Begin& begin, Contacts& contacts) noexcept;
  /// ContactFinder::relinearise().
  void relinearise(const Field3& position, Contacts& contacts) noexcept;
  void limitRecovery(double most) noexcept { max_recovery_ = most; }

  /// Adds contacts for parts that would cross an obstacle along the motion from start to end; returns how many.
  /// links_hold: no link is longer than kOverlong at the end.
  int verify(const Field3& start, const Field3& end, bool links_hold, Contacts& contacts) noexcept;
  /// The last verify() ran out of room: crossings may be missing.
  bool full() const noexcept { return full_; }

  /// Makes parts that would cross an obstacle from start to end move with it; returns how many were added.
  int advect(const Field3& start, Field3& end) noexcept;
  /// If exactly one of two nodes moves with an obstacle, the other joins it. False: neither or both do.
  bool advectAlong(std::size_t a, std::size_t b, const Field3& start, Field3& end) noexcept;
  /// Nodes that move with no obstacle stay where they started.
  void freezeRest(const Field3& start, Field3& end) const noexcept;
  void endAdvection() noexcept;

  /// After an accepted substep: takes its contacts into the wrenches. What counts is the momentum that the cloth has
  /// got from them, over the time that its forces acted for, which is not the substep's length where steps change.
  void remember(const Contacts& contacts, const Field3& position, const SubstepOutcome& outcome) noexcept;
  /// Accepted substeps without contact are undone, whose forces acted for `time` [s] in all.
  void withdraw(double time) noexcept { acted_ -= time; }
  /// Results do not depend on it.
  void clearCaches() noexcept;
  void serialize(Archive& archive);

  /// For the cloth at `position`. Too slow for every substep.
  ObstacleStanding standing(int obstacle, const Field3& position) const noexcept;

  /// Begins a frame, over which wrenches are averaged. links_hold: no link is overlong, no pin moves.
  void beginFrame(bool links_hold) noexcept;
  /// Wrench of the cloth on an obstacle, mean over the frame.
  ContactWrench wrench(int obstacle) const noexcept;

  /// Largest penetration of a node [m]; 0: none.
  double deepest(const Contacts& contacts, const Field3& position) const noexcept;

 private:
  struct Load {
    Vec3 impulse = Vec3::Zero(), angular = Vec3::Zero();  // [N s], [N m s]
    int contacts = 0;

    void serialize(Archive& archive);
  };
  const MovingObstacle& moving(std::size_t obstacle) const noexcept {
    return obstacles_.moving(static_cast<int>(obstacle));
  }
  ObstacleSubstep substepOf(std::size_t obstacle) const noexcept {
    return {moving(obstacle), static_cast<int>(obstacle), h_, act_, frictionless_, recovery_speed_, max_recovery_};
  }
  void addHeld(const Field3& position, const SubstepOutcome& outcome) noexcept;
  void addLoad(int obstacle, const Vec3& point, const Vec3& impulse, bool pushes) noexcept;
  bool anyWithin(const Eigen::AlignedBox3d& box) const noexcept;
  Eigen::AlignedBox3d reached(Eigen::AlignedBox3d box) const noexcept;
  bool findSurface(const Field3& position, Contact& contact, SurfacePoint& surface) noexcept;
  Contact& faceMet(Contact& first, const SurfacePoint& surface, const Field3& position, Contacts& contacts) noexcept;
  bool activate(const Field3& start, const Field3& end, bool links_hold) noexcept;
  void findCrossings(const Field3& start, const Field3& end, bool links_hold) noexcept;
  bool advectNode(std::uint32_t node, int obstacle, const Field3& start, Field3& end) noexcept;

  const ClothPattern& pattern_;
  const Workers& workers_;
  double thickness_, recovery_speed_;
  double max_recovery_ = std::numeric_limits<double>::infinity();  // in a substep [m]
  ObstacleSet& obstacles_;
  Pads pads_;
  SampledBounds bounds_;
  Eigen::AlignedBox3d start_box_;               // around the cloth at the start of the substep
  std::vector<ObstacleCandidates> candidates_;  // by obstacle
  std::vector<std::uint8_t> active_;            // by obstacle: near in this substep
  bool frictionless_ = false;                   // this substep
  double h_ = 0.0;                              // [s]
  ContactFinder::ForcesAct act_ = ContactFinder::ForcesAct::kAtStart;
  bool full_ = false;
  std::size_t begun_ = 0;                  // contacts that the substep began with
  std::vector<std::uint8_t> met_another_;  // by these: the node has met another face
  std::vector<Crossing> crossings_;
  std::vector<PenetratingFace> penetrating_;
  std::vector<std::int32_t> advected_by_;  // by node: obstacle it moves with, or -1
  std::vector<std::uint32_t> advected_;
  // What an obstacle gives to a node that it takes along.
  struct Held {
    std::uint32_t node;
    int obstacle;
    Vec3 impulse;  // on the obstacle [N s]
  };
  std::vector<Held> held_;   // in this substep
  std::vector<Load> loads_;  // by obstacle
  double acted_ = 0.0;       // time that the forces of the frame acted for [s]
};

}  // namespace curtain
