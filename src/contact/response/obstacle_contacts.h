// SPDX-License-Identifier: BSD-3-Clause
//
// Contact of the cloth with obstacles: parts that may touch within the substep are held to planes, tangent to the
// obstacle and a thickness away, with Coulomb friction against the moving surface. Inelastic. What would go through all
// the same gets planes where it goes in, and as a last resort goes with the obstacle.
//
//   box around a few nodes  an obstacle outside it costs next to nothing
//   box around all          nor much one outside that
//   vicinity (vicinity.h)   candidates
//   touch (obstacle_touch.h)  of those, what touches in the substep
//
// All of it follows from where the nodes start and end: what is kept from substep to substep (planes of a convex
// shape's surface, candidates candidates a mesh) serves as long as motion that is measured allows, and no result
// depends on that.
#pragma once

#include <limits>
#include <vector>

#include "cloth/link_ways.h"
#include "contact/broad_phase/obstacle_candidates.h"
#include "contact/response/element_contacts.h"
#include "contact/shapes/obstacle_set.h"
#include "curtain_sim/statistics.h"
#include "solver/contacts.h"

namespace curtain {

/// Where an obstacle is, for contact.
enum class ObstacleStanding { kAbsent, kFar, kNear };

class ObstacleContacts {
 public:
  /// Of params thickness and recovery_speed; pattern and obstacles must outlive this.
  ObstacleContacts(const ClothPattern& pattern, const ContactParams& params, const ObstacleSet& obstacles,
                   const Workers& workers);

  /// Begins a substep of h [s]: adds what may touch on the way from start to predicted, in the order of the obstacles'
  /// names, of the contacts' nodes and features. frictionless: without friction.
  void begin(const Field3& start, const Field3& predicted, double h, bool frictionless, Contacts& contacts) noexcept;
  void limitRecovery(double most) noexcept { most_recovery_ = most; }

  /// Adds contacts for parts of the cloth that would go through an obstacle on the way from start to end, expected or
  /// not; returns how many. links_hold: no link is longer than kOverlong at the end.
  int verify(const Field3& start, const Field3& end, bool links_hold, Contacts& contacts) noexcept;
  /// The last one had no room for all that is near: what it says is not certain.
  bool full() const noexcept { return full_; }

  /// Lets the parts that would go through an obstacle on the way from start to end go along with it; returns how many
  /// there were with a node that did not yet.
  int advect(const Field3& start, Field3& end) noexcept;
  /// One of two nodes that go along with an obstacle takes the other one with it; false: neither or both do.
  bool advectAlong(std::size_t a, std::size_t b, const Field3& start, Field3& end) noexcept;
  /// Nodes that go along with none stay where they are.
  void freezeRest(const Field3& start, Field3& end) const noexcept;
  void endAdvection() noexcept;

  /// After an accepted substep of h [s] that ended at position: contacts that push, whose multipliers are scale [s^2]
  /// times the forces.
  void remember(const Contacts& pushing, const Field3& position, double h, double scale) noexcept;
  /// Of these substeps such that nothing touched in are undone, so much time altogether [s].
  void takeBack(double time) noexcept { loaded_for_ -= time; }
  /// Nothing that comes differs by it, but computing time.
  void clearCaches() noexcept;
  void carry(Archive& archive);

  /// For a cloth that is here now. Not made for every substep.
  ObstacleStanding standing(int obstacle, const Field3& position) const noexcept;

  /// A frame begins: wrenches are those of its substeps from now on. links_hold: none is much too long, no pin is
  /// moved.
  void beginFrame(bool links_hold) noexcept;
  /// What the cloth exerts on an obstacle, mean over the frame's substeps.
  ContactWrench wrench(int obstacle) const noexcept;

  /// How deep the deepest node is inside an obstacle [m]; 0: none is.
  double deepest(const Contacts& contacts, const Field3& position) const noexcept;

 private:
  struct Load {
    Vec3 impulse = Vec3::Zero(), angular = Vec3::Zero();  // [N s], [N m s]
    int contacts = 0;

    void carry(Archive& archive);
  };
  ObstacleSubstep substepOf(std::size_t obstacle) const noexcept {
    return {
        obstacles_.moving()[obstacle], static_cast<int>(obstacle), h_, frictionless_, recovery_speed_, most_recovery_};
  }
  bool anyWithin(const Eigen::AlignedBox3d& box) const noexcept;
  Eigen::AlignedBox3d reached(Eigen::AlignedBox3d box) const noexcept;
  bool activate(const Field3& start, const Field3& end, bool links_hold) noexcept;
  void findCrossings(const Field3& start, const Field3& end, bool links_hold) noexcept;
  bool advectNode(std::uint32_t node, int obstacle, const Field3& start, Field3& end) noexcept;

  const ClothPattern& pattern_;
  double thickness_, recovery_speed_;
  double most_recovery_ = std::numeric_limits<double>::infinity();  // in a substep [m]
  const ObstacleSet& obstacles_;
  SampledBounds bounds_;
  Eigen::AlignedBox3d start_box_;               // around the cloth where it starts
  std::vector<ObstacleCandidates> candidates_;  // by obstacle
  std::vector<std::uint8_t> active_;            // by obstacle: may be touched in this substep
  bool frictionless_ = false;                   // this substep
  double h_ = 0.0;                              // [s]
  bool full_ = false;
  std::vector<Crossing> crossings_;
  std::vector<PenetratingFace> penetrating_;
  std::vector<std::int32_t> advected_by_;  // by node: obstacle, or -1
  std::vector<std::uint32_t> advected_;
  std::vector<Load> loads_;  // by obstacle
  double loaded_for_ = 0.0;  // [s]
};

}  // namespace curtain
