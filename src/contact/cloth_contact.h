// SPDX-License-Identifier: BSD-3-Clause
//
// All contact of a cloth: what may touch within a substep, and whether anything went through anything after all.
//
//   begin    contacts: what touches on the predicted way, with the multipliers of the last accepted substep
//   verify   what would go through something on the solved way becomes a contact too, and the solve goes on
//   hold     what still would is moved as one body (zones.h)
//
// Contacts come from positions and those multipliers alone, in the order of the obstacles' names and of the nodes. What
// is kept beside them saves time and changes no bit of a result.
#pragma once

#include "contact/broad_phase/cloth_flatness.h"
#include "contact/broad_phase/self_candidates.h"
#include "contact/response/impact_zones.h"
#include "contact/response/obstacle_contacts.h"
#include "contact/response/self_contacts.h"
#include "contact/shapes/obstacle_set.h"
#include "solver/substep.h"

namespace curtain {

class ClothContact : public ContactFinder {
 public:
  /// stretch_tolerance: of links in a substep that settles, relative; pattern, obstacles and workers must outlive this.
  ClothContact(const ClothPattern& pattern, const ContactParams& params, const ObstacleSet& obstacles,
               double stretch_tolerance, const Workers& workers);

  /// There is something to look for at all.
  bool wanted() const noexcept { return self_wanted_ || obstacles_.anyPresent(); }

  /// What is nearer than it should be comes out by no more than this in the substeps to come [m]; infinite: at its own
  /// speed.
  void limitRecovery(double most) noexcept {
    obstacle_contacts_.limitRecovery(most);
    self_contacts_.limitRecovery(most);
  }

  Contacts& begin(const Field3& start, const Field3& predicted, double h) noexcept override;
  Verdict verify(const Field3& start, const Field3& end, bool settled) noexcept override;
  void hold(const Field3& start, Field3& end) noexcept override;

  /// In a substep that it is not asked to begin, for there is nothing to look for.
  void skipSubstep() noexcept { contacts_.clear(); }
  /// Where the cloth is put elsewhere; nothing that comes differs by it, but computing time.
  void clearCaches() noexcept;
  /// For tests: from now on that is done at every other look or so, drawn from seed; 0: no more.
  void clearCachesAtRandom(std::uint64_t seed) noexcept { clearing_ = seed; }
  /// After every accepted substep of h [s] that ended at position, whether all links could be brought to their lengths;
  /// scale: its h * kick [s^2].
  void afterSubstep(bool settled, double h, double scale, const Field3& position) noexcept;
  /// Before the first substep of every frame.
  void beginFrame(bool links_hold) noexcept { obstacle_contacts_.beginFrame(links_hold); }

  /// Contacts that find room without an allocation.
  std::size_t capacity() const noexcept { return contacts_.capacity(); }
  ObstacleStanding standing(int obstacle, const Field3& position) const noexcept {
    return obstacle_contacts_.standing(obstacle, position);
  }
  /// Something of the last substep may touch.
  bool any() const { return !contacts_.empty(); }
  const Contacts& contacts() const { return contacts_; }
  /// Those of the last accepted substep that push, in order.
  const Contacts& pushing() const noexcept { return last_; }
  /// How deep the deepest node is inside an obstacle [m]; 0: none is.
  double deepestPenetration(const Field3& position) const noexcept {
    return obstacle_contacts_.deepest(contacts_, position);
  }
  /// Of the cloth on an obstacle, in the last frame.
  ContactWrench wrench(int obstacle) const noexcept { return obstacle_contacts_.wrench(obstacle); }
  /// Adds the contact forces of the last substep [N].
  void addForces(Field3& force) const noexcept;
  void forget() noexcept;
  /// The next substep does not start where the last accepted one ended.
  void invalidateStart() noexcept {
    taut_ = false;
    flatness_.invalidate();
  }
  /// Accepted substeps of so much time altogether [s], in which nothing touched, are undone.
  void takeBack(double time) noexcept { obstacle_contacts_.takeBack(time); }
  void carry(Archive& archive);

 private:
  void carryPushing(Archive& archive, Contact& contact) const;
  void clearAtRandom() noexcept;
  bool staysFlat(const Field3& end, bool settled) noexcept;
  void find(const Field3& start, const Field3& end, double reach) noexcept;
  void warmStart() noexcept;
  bool before(const Contact& a, const Contact& b) const noexcept;
  int joinCrossings(const Field3& start, const Field3& end) noexcept;
  void freezeZones(const Field3& start, Field3& end) noexcept;
  void advectWithObstacles(const Field3& start, Field3& end) noexcept;

  const ClothPattern& pattern_;
  const ObstacleSet& obstacles_;
  bool self_wanted_;
  int zone_iterations_;
  ObstacleContacts obstacle_contacts_;
  SelfContacts self_contacts_;
  SelfCandidates self_candidates_;
  ClothFlatness flatness_;
  Candidates candidates_;  // of the way from the substep's start to where nodes were predicted, and to elsewhere
  ImpactZones zones_;
  Contacts contacts_, last_;       // of this substep; of the last accepted one, those that pushed, in their order
  double h_ = 0.0;                 // of this substep [s]
  double last_scale_ = 0.0;        // of the last one's multipliers [s^2]
  bool taut_ = false;              // links hold where the substep starts
  bool flat_ = false;              // and the cloth is flat there
  int verify_count_ = 0;           // times that the present substep was verified
  int frictionless_substeps_ = 0;  // substeps still to go without friction
  std::uint64_t clearing_ = 0;     // state of the random numbers, see clearCachesAtRandom()
};

}  // namespace curtain
