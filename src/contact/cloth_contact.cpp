// SPDX-License-Identifier: BSD-3-Clause
#include "contact/cloth_contact.h"

#include <algorithm>
#include <tuple>

namespace curtain {
namespace {

// Substeps without friction after one that did not settle: friction could lock overlong links in place.
constexpr int kFrictionlessSubsteps = 64;
// Gap of self-contact, at most this share of the shortest link: with more, a row would touch its neighbours.
constexpr double kGapPerLink = 0.25;
// The flatness proof is for this multiple of the gap, so that it fails before parts touch.
constexpr double kFlatReach = 1.25;
// Rounds of advection with an obstacle: parts that move with it may push others. Then the rest stops.
constexpr int kAdvectionRounds = 64;

// Candidates for crossings, over the gap: twice the share that counts as crossing, for uncertainty of the time of
// impact.
constexpr double kCrossingReach = 2.0 * SelfContacts::kMinShare;

}  // namespace

ClothContact::ClothContact(const ClothPattern& pattern, const ContactParams& params, ObstacleSet& obstacles,
                           double stretch_tolerance, const Workers& workers)
    : pattern_(pattern),
      obstacles_(obstacles),
      self_wanted_(params.self),
      zone_iterations_(params.zone_iterations),
      obstacle_contacts_(pattern, params, obstacles, workers),
      self_contacts_(pattern, std::min(params.thickness, kGapPerLink * shortestLink(pattern)), params),
      self_candidates_(pattern, &workers),
      flatness_(pattern, stretch_tolerance),
      zones_(pattern) {
  if (obstacles.count() == 0 && !params.self) return;
  contacts_.reserve(ObstacleContacts::kRoomPerNode * pattern.grid.nodeCount());
  last_.reserve(ObstacleContacts::kRoomPerNode * pattern.grid.nodeCount());
  if (!params.self) return;
  self_candidates_.reserve(candidates_);
}

// Order of contacts: self-contact first, then obstacles by name; each by the parts of the cloth that touch.
bool ClothContact::before(const Contact& a, const Contact& b) const noexcept {
  const auto rank = [this](const Contact& c) {
    return c.obstacle == Contact::kCloth ? -1 : obstacles_.rank(c.obstacle);
  };
  return std::make_tuple(rank(a), a.nodes, a.node) < std::make_tuple(rank(b), b.nodes, b.node);
}

void ClothContact::find(const Field3& start, const Field3& end, double reach) noexcept {
  candidates_.clear();
  self_candidates_.collect(start, end, reach, candidates_);
}

// Xorshift (Marsaglia 2003): never reaches 0.
void ClothContact::clearAtRandom() noexcept {
  clearing_ ^= clearing_ << 13;
  clearing_ ^= clearing_ >> 7;
  clearing_ ^= clearing_ << 17;
  if ((clearing_ & 1U) != 0) clearCaches();
}

// Cloth that is proven flat at the start has no candidates.
Contacts& ClothContact::begin(const Field3& start, const Field3& predicted, double h, ForcesAct act) noexcept {
  if (clearing_ != 0) clearAtRandom();
  contacts_.clear();
  h_ = h;
  verify_count_ = 0;
  if (self_wanted_) {
    flat_ = taut_ && flatness_.isFlat(start, kFlatReach * self_contacts_.gap());
    if (flat_)
      candidates_.clear();
    else
      find(start, predicted, self_contacts_.gap());
    self_contacts_.collect(candidates_, last_, start, predicted, h, contacts_);
  }
  obstacle_contacts_.begin(start, predicted, {h, act, frictionless_substeps_ > 0}, contacts_);
  warmStart();
  return contacts_;
}

// Both lists are sorted. A part of the cloth touches few features of one obstacle.
void ClothContact::warmStart() noexcept {
  auto first = last_.begin();
  for (Contact& contact : contacts_) {
    while (first != last_.end() && before(*first, contact)) ++first;
    for (auto old = first; old != last_.end() && !before(contact, *old); ++old) {
      if (old->source != contact.source || old->ran_into) continue;
      contact.push = contact.press > 0.0 ? old->push : std::max(0.0, old->push);
      contact.slide = old->slide;
    }
  }
}

bool ClothContact::staysFlat(const Field3& end, bool settled) noexcept {
  return flat_ && settled && flatness_.staysFlat(end, kFlatReach * self_contacts_.gap());
}

ContactFinder::Verdict ClothContact::verify(const Field3& start, const Field3& end, bool settled) noexcept {
  if (clearing_ != 0) clearAtRandom();
  int added = 0;
  bool full = false;
  if (self_wanted_ && !staysFlat(end, settled)) {
    if (flat_)
      find(start, end, self_contacts_.gap());
    else
      self_candidates_.collectDeviating(end, kCrossingReach * self_contacts_.gap(), candidates_);
    flat_ = false;
    added = self_contacts_.verify(candidates_, start, end, h_, contacts_);
    full = self_contacts_.full();
  }
  added += obstacle_contacts_.verify(start, end, settled, contacts_);
  if (full || obstacle_contacts_.full()) return Verdict::kCrossed;
  if (added == 0) return Verdict::kClear;
  return ++verify_count_ <= zone_iterations_ ? Verdict::kMore : Verdict::kCrossed;
}

void ClothContact::hold(const Field3& start, Field3& end) noexcept {
  if (clearing_ != 0) clearAtRandom();
  flat_ = false;
  if (self_wanted_) freezeZones(start, end);
  if (obstacles_.anyPresent()) advectWithObstacles(start, end);
}

// Parts that would cross an obstacle move with it, and parts that those would cross move along. If that does not end,
// the rest of the cloth stays where it is.
void ClothContact::advectWithObstacles(const Field3& start, Field3& end) noexcept {
  bool done = false;
  for (int round = 0; round < kAdvectionRounds && !done; ++round) {
    int count = obstacle_contacts_.advect(start, end);
    if (self_wanted_ && count > 0) {
      find(start, end, kCrossingReach * self_contacts_.gap());
      self_contacts_.forEachCrossing(candidates_, start, end, [&](const PairKey& pair) {
        for (const std::uint32_t node : pair.node)
          count += obstacle_contacts_.advectAlong(pair.node[0], node, start, end) ? 1 : 0;
      });
    }
    done = count == 0 && !obstacle_contacts_.full() && !self_contacts_.full();
  }
  if (!done) obstacle_contacts_.freezeRest(start, end);
  obstacle_contacts_.endAdvection();
}

void ClothContact::freezeZones(const Field3& start, Field3& end) noexcept {
  zones_.clear();
  const auto is_done = [&] { return joinCrossings(start, end) == 0 && !self_contacts_.full(); };
  for (int round = 0; round < zone_iterations_; ++round) {
    if (is_done()) return;
    zones_.makeRigid(start, end);
  }
  for (int round = 0; round < zone_iterations_; ++round) {
    if (is_done()) return;
    zones_.stop(start, end);
  }
  if (is_done()) return;
  for (std::size_t n = 1; n < pattern_.grid.size(); ++n) {
    if (pattern_.mass[n] > 0.0) zones_.join(0, n);
  }
  zones_.stop(start, end);
}

// Merges the nodes of every crossing pair into one zone; returns the number of such pairs.
int ClothContact::joinCrossings(const Field3& start, const Field3& end) noexcept {
  int count = 0;
  if (!self_wanted_) return count;
  find(start, end, kCrossingReach * self_contacts_.gap());
  self_contacts_.forEachCrossing(candidates_, start, end, [&](const PairKey& pair) {
    for (std::size_t k = 1; k < 4; ++k) zones_.join(pair.node[0], pair.node[k]);
    ++count;
  });
  return count;
}

void ClothContact::afterSubstep(bool settled, const SubstepOutcome& outcome, const Field3& position) noexcept {
  taut_ = settled;
  if (flat_)
    flatness_.advance();
  else
    flatness_.invalidate();
  if (!settled)
    frictionless_substeps_ = kFrictionlessSubsteps;
  else if (frictionless_substeps_ > 0)
    --frictionless_substeps_;
  last_.clear();
  for (const Contact& contact : contacts_) {
    if (contact.pushes()) last_.push_back(contact);
  }
  // verify() appends out of order.
  const auto in_order = [this](const Contact& a, const Contact& b) { return before(a, b); };
  if (!std::is_sorted(last_.begin(), last_.end(), in_order)) std::sort(last_.begin(), last_.end(), in_order);
  last_scale_ = outcome.scale;
  obstacle_contacts_.remember(contacts_, position, outcome);
}

void ClothContact::addForces(Field3& force) const noexcept {
  if (last_scale_ == 0.0) return;
  for (const Contact& contact : last_) {
    const Vec3 total = (contact.push * contact.normal + contact.slide) / last_scale_;
    for (int k = 0; k < contact.nodes; ++k) {
      const auto at = static_cast<std::size_t>(k);
      force.add(contact.node[at], contact.weight[at] * total);
    }
  }
}

void ClothContact::copyForces(const Field3& position, std::vector<ContactForce>& out) const {
  out.clear();
  for (const Contact& contact : last_) {
    if (contact.obstacle == Contact::kCloth) continue;
    const bool pinched = contact.other != Contact::kCloth;
    const double share = (pinched ? 0.5 : 1.0) / last_scale_;
    const Vec3 point = contact.point(position), friction = -share * contact.slide;
    out.push_back({contact.obstacle, point, contact.normal, contact.press + share * contact.push, friction});
    if (pinched) out.push_back({contact.other, point, -contact.normal, contact.press - share * contact.push, friction});
  }
  std::stable_sort(out.begin(), out.end(), [this](const ContactForce& a, const ContactForce& b) {
    return obstacles_.rank(a.obstacle) < obstacles_.rank(b.obstacle);
  });
}

void ClothContact::forget() noexcept {
  contacts_.clear();
  last_.clear();
  last_scale_ = 0.0;
  frictionless_substeps_ = 0;
  taut_ = false;
  clearCaches();
  obstacle_contacts_.beginFrame(true);
}

void ClothContact::pinsChanged() noexcept {
  self_candidates_.pinsChanged(pattern_);
  flatness_.pinsChanged();
  flatness_.invalidate();
}

void ClothContact::clearCaches() noexcept {
  flatness_.invalidate();
  obstacle_contacts_.clearCaches();
}

}  // namespace curtain
