// SPDX-License-Identifier: BSD-3-Clause
//
// All contact of a cloth: what may touch within a substep, and whether anything went through anything after all.
//
//   begin    contacts: of what was near when the last substep ended, what touches on the predicted way
//   verify   what would go through something on the solved way becomes a contact too, and the solve goes on
//   hold     what still would is moved as one body (zones.h)
#pragma once

#include "contact/kept_pairs.h"
#include "contact/obstacle_contacts.h"
#include "contact/obstacle_set.h"
#include "contact/self_contacts.h"
#include "contact/taut_net.h"
#include "contact/zones.h"
#include "solver/substep.h"

namespace curtain {

class ClothContact : public ContactFinder {
 public:
  /// frame_length [s]; stretch_tolerance: of links in a substep that settles, relative; pattern and obstacles must
  /// outlive this.
  ClothContact(const ClothPattern& pattern, const ContactParams& params, double frame_length,
               const ObstacleSet& obstacles, double stretch_tolerance);

  /// There is something to look for at all.
  bool wanted() const noexcept { return self_wanted_ || obstacles_.anyPresent(); }

  Contacts* begin(const Field3& start, const Field3& predicted, double h) noexcept override;
  Verdict verify(const Field3& start, const Field3& end, bool settled) noexcept override;
  void hold(const Field3& start, Field3& end) noexcept override;

  /// In a substep that it is not asked to begin, for there is nothing to look for.
  void nothingTouches() noexcept { contacts_.clear(); }
  /// After every accepted substep of h [s] that ended at position, whether all links could be brought to their lengths;
  /// scale: its h * kick [s^2].
  void afterSubstep(bool settled, double h, double scale, const Field3& position) noexcept;
  /// Before the first substep of every frame.
  void beginFrame(bool links_hold) noexcept { touch_.beginFrame(links_hold); }

  /// Contacts that find room without an allocation.
  std::size_t capacity() const noexcept { return contacts_.capacity(); }
  ObstacleStanding standing(int obstacle, const Field3& position) const noexcept { return touch_.standing(obstacle, position); }
  /// Something of the last substep may touch.
  bool any() const { return !contacts_.empty(); }
  const Contacts& contacts() const { return contacts_; }
  /// Contacts that were pressed on in the last substep.
  int contactCount() const noexcept { return static_cast<int>(last_.size()); }
  /// How deep the deepest node is inside an obstacle [m]; 0: none is.
  double deepestPenetration(const Field3& position) const noexcept { return touch_.deepest(contacts_, position); }
  /// Of the cloth on an obstacle, in the last frame.
  ContactWrench wrench(int obstacle) const noexcept { return touch_.wrench(obstacle); }
  /// Adds the contact forces of the last substep [N].
  void addForces(Field3& force) const noexcept;
  void forget() noexcept;
  /// The next substep does not start where the last accepted one ended.
  void lookAfresh() noexcept { ended_ = {}; }
  /// Accepted substeps of so much time altogether [s], in which nothing touched, are undone.
  void takeBack(double time) noexcept { touch_.takeBack(time); }
  void carry(Archive& archive);

 private:
  bool staysFlat(const Field3& start, const Field3& end, bool settled) noexcept;
  void look(const Field3& start, const Field3& end) noexcept;
  int joinCrossings(const Field3& start, const Field3& end) noexcept;
  void holdSelf(const Field3& start, Field3& end) noexcept;
  void holdToObstacles(const Field3& start, Field3& end) noexcept;

  const ClothPattern& pattern_;
  const ObstacleSet& obstacles_;
  bool self_wanted_;
  int zone_iterations_;
  ObstacleContacts touch_;
  SelfContacts self_;
  KeptPairs pairs_;
  TautNet net_;
  // What is known of where a substep starts, for it is where the last one ended.
  struct Known {
    bool taut = false;  // that one settled
    bool seen = false;  // by net_, last of all

    void carry(Archive& archive);
  };
  Known started_, ended_;
  bool flat_ = false;         // the net has proved it of the present substep
  Candidates candidates_;
  Field3 ahead_;           // where nodes go on to from the last look [m]
  bool looked_ = false;    // the pairs near each other now are known
  Zones zones_;
  Contacts contacts_, last_;  // of this substep; of the last accepted one, those that pushed
  double h_ = 0.0;            // of this substep [s]
  double last_scale_ = 0.0;   // of the last one's multipliers [s^2]
  bool near_obstacle_ = false;
  int looks_ = 0;             // times that the present substep was verified
  int slippery_ = 0;          // substeps still to go without friction
};

}  // namespace curtain
