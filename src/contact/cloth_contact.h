// SPDX-License-Identifier: BSD-3-Clause
//
// All contact of one cloth, with obstacles and with itself, as the solver's ContactFinder.
//
//   begin    contacts along the predicted motion, warm-started with the multipliers of the last accepted substep
//   verify   continuous detection along the solved motion: pairs that would cross become contacts; solve again
//   hold     last resort: what still would cross moves as one body (impact_zones.h) or with the obstacle
//
// Contacts depend on positions and those multipliers only, and are sorted by the obstacles' names and by node. Caches
// change no bit of a result.
#pragma once

#include "contact/broad_phase/flat_cloths.h"
#include "contact/broad_phase/self_candidates.h"
#include "contact/response/impact_zones.h"
#include "contact/response/obstacle_contacts.h"
#include "contact/response/self_contacts.h"
#include "obstacles/obstacle_set.h"
#include "step/substep.h"

namespace curtain {

class ClothContact : public ContactFinder {
 public:
  /// stretch_tolerance: largest strain of a link in a settled substep; pattern, obstacles and workers must outlive
  /// this.
  ClothContact(const ClothPattern& pattern, const ContactParams& params, ObstacleSet& obstacles,
               double stretch_tolerance, const Workers& workers);

  /// Whether contact is possible at all.
  bool wanted() const noexcept { return self_wanted_ || obstacles_.anyPresent(); }

  /// Limits depenetration to this distance per substep [m] from now on; infinite: only the recovery speed limits it.
  void limitRecovery(double most) noexcept {
    obstacle_contacts_.limitRecovery(most);
    self_contacts_.limitRecovery(most);
  }

  /// Sets the friction of the cloth on itself; the obstacles have their own.
  void setFriction(double friction) noexcept { self_contacts_.setFriction(friction); }
  /// Sets the largest strain of a link in a settled substep. Where links are longer now, invalidateStart() must follow.
  void setStretchTolerance(double tolerance) noexcept { flatness_.setOverlong(tolerance); }

  Contacts& begin(const Field3& start, const Field3& predicted, double h, ForcesAct act) noexcept override;
  void relinearise(const Field3& position, Contacts& contacts) noexcept override {
    obstacle_contacts_.relinearise(position, contacts);
  }
  Verdict verify(const Field3& start, const Field3& end, bool settled) noexcept override;
  void hold(const Field3& start, Field3& end) noexcept override;

  /// For a substep without begin(), because contact is impossible.
  void skipSubstep() noexcept { contacts_.clear(); }
  /// When the cloth was placed elsewhere. Only computing time depends on it, no result.
  void clearCaches() noexcept;
  /// For tests: clears the caches in about every other call from now on, drawn from seed; 0: stop.
  void clearCachesAtRandom(std::uint64_t seed) noexcept { clearing_ = seed; }
  /// After every accepted substep that ended at position. settled: all links are within tolerance.
  void afterSubstep(bool settled, const SubstepOutcome& outcome, const Field3& position) noexcept;
  /// Before the first substep of every frame. links_hold: no link is overlong, no pin moves.
  void beginFrame(bool links_hold) noexcept { obstacle_contacts_.beginFrame(links_hold); }

  /// Contacts that fit without an allocation.
  std::size_t capacity() const noexcept { return contacts_.capacity(); }
  ObstacleStanding standing(int obstacle, const Field3& position) const noexcept {
    return obstacle_contacts_.standing(obstacle, position);
  }
  /// The last substep had contacts.
  bool any() const { return !contacts_.empty(); }
  const Contacts& contacts() const { return contacts_; }
  /// Contacts of the last accepted substep that push, sorted.
  const Contacts& pushing() const noexcept { return last_; }
  /// Largest penetration of a node into an obstacle [m]; 0: none.
  double deepestPenetration(const Field3& position) const noexcept {
    return obstacle_contacts_.deepest(contacts_, position);
  }
  /// Wrench of the cloth on an obstacle, mean over the last frame.
  ContactWrench wrench(int obstacle) const noexcept { return obstacle_contacts_.wrench(obstacle); }
  /// Adds the contact forces of the last substep [N].
  void addForces(Field3& force) const noexcept;
  /// Those on obstacles, one by one, for the cloth at `position`; resized.
  void copyForces(const Field3& position, std::vector<ContactForce>& out) const;
  void forget() noexcept;
  /// The pattern's pins have changed: links between two of them may have any length.
  void pinsChanged() noexcept;
  /// The next substep does not start at the end of the last accepted one.
  void invalidateStart() noexcept {
    taut_ = false;
    flatness_.invalidate();
  }
  /// Accepted substeps without contact are undone, whose forces acted for `time` [s] in all.
  void withdraw(double time) noexcept { obstacle_contacts_.withdraw(time); }
  void serialize(Archive& archive);

 private:
  void serializePushing(Archive& archive, Contact& contact) const;
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
  FlatCloths flatness_;
  Candidates candidates_;  // of the motion from the start to the predicted positions, completed by verify()
  ImpactZones zones_;
  Contacts contacts_, last_;       // of this substep; of the last accepted one, those that push, sorted
  double h_ = 0.0;                 // of this substep [s]
  double last_scale_ = 0.0;        // of the multipliers in last_ [s^2]
  bool taut_ = false;              // links are within tolerance at the start
  bool flat_ = false;              // and the cloth is proven flat there
  int verify_count_ = 0;           // verify() calls in this substep
  int frictionless_substeps_ = 0;  // substeps left without friction
  std::uint64_t clearing_ = 0;     // random state, see clearCachesAtRandom()
};

}  // namespace curtain
