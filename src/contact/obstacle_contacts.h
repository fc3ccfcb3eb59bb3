// SPDX-License-Identifier: BSD-3-Clause
//
// Contact of the cloth with obstacles: parts that may touch within the substep are held to planes, tangent to the obstacle and a
// thickness away, with Coulomb friction against the moving surface. Inelastic. What would go through all the same gets
// planes where it goes in, and as a last resort goes with the obstacle.
//
//   box around a few nodes  an obstacle outside it costs next to nothing
//   box, for some frames    nor does one outside that
//   vicinity (vicinity.h)   nodes and elements near it
//   touch (obstacle_touch.h)  of those, what touches in the substep
#pragma once

#include <vector>

#include "cloth/link_ways.h"
#include "contact/obstacle_set.h"
#include "contact/obstacle_touch.h"
#include "contact/vicinity.h"
#include "curtain_sim/statistics.h"
#include "solver/contacts.h"

namespace curtain {

/// Where an obstacle is, for contact.
enum class ObstacleStanding { kAbsent, kFar, kNear };

class ObstacleContacts {
 public:
  /// Of params thickness and recovery_speed; frame [s]; pattern and obstacles must outlive this.
  ObstacleContacts(const ClothPattern& pattern, const ContactParams& params, double frame, const ObstacleSet& obstacles);

  /// Some obstacle may be touched in a substep of h [s] whose nodes go from start to about predicted. False: none can, whatever
  /// the links do.
  bool mayTouch(const Field3& start, const Field3& predicted, double h) noexcept;

  /// Adds what may touch on the way from start to predicted, in a substep of h [s], with the multipliers of the last accepted
  /// substep. slippery: without friction. After mayTouch().
  void collect(const Field3& start, const Field3& predicted, double h, bool slippery, Contacts& contacts) noexcept;

  /// Adds contacts for parts of the cloth that would go through an obstacle on the way from start to end; returns how many.
  int verify(const Field3& start, const Field3& end, double h, Contacts& contacts) noexcept;

  /// Lets the parts that would go through an obstacle on the way from start to end go along with it; returns how many there were
  /// with a node that did not yet.
  int carry(const Field3& start, Field3& end, double h) noexcept;
  /// One of two nodes that go along with an obstacle takes the other one with it; false: neither or both do.
  bool carryAlong(std::size_t a, std::size_t b, const Field3& start, Field3& end) noexcept;
  void endCarrying() noexcept;

  /// Takes over the multipliers of an accepted substep of h [s] that ended at position, where they are scale [s^2] times the
  /// forces; contacts: null when nothing could touch.
  void remember(const Contacts& contacts, const Field3& position, double h, double scale) noexcept;
  /// Of these substeps such that nothing touched in are undone, so much time altogether [s].
  void takeBack(double time) noexcept { loaded_for_ -= time; }
  void forget() noexcept;
  void carry(Archive& archive);

  /// For a cloth that is here now. Not made for every substep.
  ObstacleStanding standing(int obstacle, const Field3& position) const noexcept;

  /// A frame begins: wrenches are those of its substeps from now on. links_hold: none is much too long, no pin is moved.
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
  ObstacleSubstep substepOf(std::size_t obstacle, double h, bool slippery) const noexcept {
    return {obstacles_.moving()[obstacle], static_cast<int>(obstacle), h, slippery, recovery_speed_};
  }
  bool before(const Contact& a, const Contact& b) const noexcept;
  bool anyWithin(const Eigen::AlignedBox3d& box) const noexcept;
  void lookAtCloth(const Field3& start, const Field3& predicted, double h) noexcept;
  void findCrossings(const Field3& start, const Field3& end, double h) noexcept;
  void warmStart(std::size_t first, Contacts& contacts) const noexcept;

  const ClothPattern& pattern_;
  double thickness_, recovery_speed_, frame_;
  const ObstacleSet& obstacles_;
  SampledBounds bounds_;              // of the cloth now
  Eigen::AlignedBox3d box_;           // of the cloth for box_time_
  double box_time_ = 0.0;             // [s]
  std::vector<Vicinity> near_;        // by obstacle
  std::vector<std::uint8_t> active_;  // by obstacle: may be touched in this substep
  bool slippery_ = false;             // this substep
  Contacts last_;                     // that pushed, in the order they are found in
  std::vector<Crossing> crossings_;
  std::vector<std::int32_t> carried_by_;  // by node: obstacle, or -1
  std::vector<std::uint32_t> carried_;
  std::vector<Load> loads_;           // by obstacle
  double loaded_for_ = 0.0;           // [s]
};

}  // namespace curtain
