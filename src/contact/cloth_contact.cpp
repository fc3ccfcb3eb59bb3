// SPDX-License-Identifier: BSD-3-Clause
#include "contact/cloth_contact.h"

#include <algorithm>

#include "cloth/wide.h"

namespace curtain {
namespace {

// Substeps without friction after one whose links could not be brought to their lengths.
constexpr int kSlipperySubsteps = 64;
// Two parts of the cloth are not kept further apart than this share of its shortest link: thicker cloth would touch its
// own next row.
constexpr double kGapPerLink = 0.25;
// How far parts of flat cloth are to be kept apart by proof, over the gap: they are looked at by themselves before they
// touch.
constexpr double kFlatReach = 1.25;
// Parts that go along with an obstacle may take more with them: so many times at most.
constexpr int kCarryRounds = 64;

CURTAIN_WIDE void goOn(const Field& start, const Field& end, Field& ahead) noexcept {
  const std::size_t size = start.size();
  const double *const a = start.data(), *const b = end.data();
  double* const out = ahead.data();
#pragma omp simd
  for (std::size_t n = 0; n < size; ++n) out[n] = 2.0 * b[n] - a[n];
}

void extrapolate(const Field3& start, const Field3& end, Field3& ahead) noexcept {
  goOn(start.x, end.x, ahead.x);
  goOn(start.y, end.y, ahead.y);
  goOn(start.z, end.z, ahead.z);
}

}  // namespace

ClothContact::ClothContact(const ClothPattern& pattern, const ContactParams& params, double frame_length,
                           const ObstacleSet& obstacles, double stretch_tolerance)
    : pattern_(pattern),
      obstacles_(obstacles),
      self_wanted_(params.self),
      zone_iterations_(params.zone_iterations),
      touch_(pattern, params, frame_length, obstacles),
      self_(pattern, std::min(params.thickness, kGapPerLink * shortestLink(pattern)), params),
      pairs_(pattern),
      net_(pattern, stretch_tolerance),
      zones_(pattern) {
  if (obstacles.count() == 0 && !params.self) return;
  contacts_.reserve(8 * pattern.grid.nodeCount());
  last_.reserve(8 * pattern.grid.nodeCount());
  if (!params.self) return;
  pairs_.reserve(candidates_);
  ahead_.assign(pattern.grid.size(), 0.0);
}

// Pairs that come near on the way from start to end, and on as far again: those that the next substep starts with.
void ClothContact::look(const Field3& start, const Field3& end) noexcept {
  extrapolate(start, end, ahead_);
  candidates_.clear();
  pairs_.collect(start, ahead_, self_.gap(), candidates_);
  self_.renew(candidates_, contacts_);
  looked_ = true;
}

Contacts* ClothContact::begin(const Field3& start, const Field3& predicted, double h) noexcept {
  contacts_.clear();
  h_ = h;
  looks_ = 0;
  started_ = ended_;
  ended_ = {};
  flat_ = false;
  if (self_wanted_) {
    if (!looked_) look(start, predicted);
    self_.collect(start, predicted, h, contacts_);
  }
  near_obstacle_ = obstacles_.anyPresent() && touch_.mayTouch(start, predicted, h);
  if (near_obstacle_) touch_.collect(start, predicted, h, slippery_ > 0, contacts_);
  return self_wanted_ || near_obstacle_ ? &contacts_ : nullptr;
}

// Cloth that is flat by far needs no look at all its nodes. Pairs near at the last look keep their multipliers, and the
// candidates are as many as before: none.
bool ClothContact::staysFlat(const Field3& start, const Field3& end, bool settled) noexcept {
  const bool goes_on = started_.seen;
  started_.seen = flat_ = false;
  if (!settled || !started_.taut || !self_.noneNear()) return false;
  return flat_ = net_.staysFlat(start, end, kFlatReach * self_.gap(), goes_on);
}

ContactFinder::Verdict ClothContact::verify(const Field3& start, const Field3& end, bool settled) noexcept {
  int added = 0;
  if (self_wanted_ && !staysFlat(start, end, settled)) {
    look(start, end);
    added = self_.verify(start, end, h_, contacts_);
  }
  if (near_obstacle_) added += touch_.verify(start, end, h_, contacts_);
  if (added == 0) return Verdict::kClear;
  return ++looks_ <= zone_iterations_ ? Verdict::kMore : Verdict::kCrossed;
}

void ClothContact::hold(const Field3& start, Field3& end) noexcept {
  if (self_wanted_) holdSelf(start, end);
  if (near_obstacle_) holdToObstacles(start, end);
}

// What would go through an obstacle goes along with it, and what that would go through or be left behind by, too.
void ClothContact::holdToObstacles(const Field3& start, Field3& end) noexcept {
  for (int round = 0; round < kCarryRounds; ++round) {
    int count = touch_.carry(start, end, h_);
    if (self_wanted_ && count > 0) {
      look(start, end);
      self_.forEachCrossing(start, end, [&](const NearPair& pair) {
        for (const std::uint32_t node : pair.key.node) {
          count += touch_.carryAlong(pair.key.node[0], node, start, end) ? 1 : 0;
        }
      });
    }
    if (count == 0) break;
  }
  touch_.endCarrying();
}

void ClothContact::holdSelf(const Field3& start, Field3& end) noexcept {
  zones_.clear();
  for (int round = 0; round < zone_iterations_; ++round) {
    if (joinCrossings(start, end) == 0) return;
    zones_.makeRigid(start, end);
  }
  for (int round = 0; round < zone_iterations_; ++round) {
    if (joinCrossings(start, end) == 0) return;
    zones_.stop(start, end);
  }
  if (joinCrossings(start, end) == 0) return;
  for (std::size_t n = 1; n < pattern_.grid.size(); ++n) {
    if (pattern_.mass[n] > 0.0) zones_.join(0, n);
  }
  zones_.stop(start, end);
}

// Nodes that would go through each other belong to one zone; returns how many pairs there were.
int ClothContact::joinCrossings(const Field3& start, const Field3& end) noexcept {
  int count = 0;
  if (!self_wanted_) return count;
  look(start, end);
  self_.forEachCrossing(start, end, [&](const NearPair& pair) {
    for (std::size_t k = 1; k < 4; ++k) zones_.join(pair.key.node[0], pair.key.node[k]);
    ++count;
  });
  return count;
}

void ClothContact::afterSubstep(bool settled, double h, double scale, const Field3& position) noexcept {
  ended_ = {settled, flat_};
  if (!settled) slippery_ = kSlipperySubsteps;
  else if (slippery_ > 0) --slippery_;
  last_.clear();
  for (const Contact& contact : contacts_) {
    if (contact.pushes()) last_.push_back(contact);
  }
  last_scale_ = scale;
  if (self_wanted_) self_.remember(contacts_);
  touch_.remember(contacts_, position, h, scale);
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

void ClothContact::forget() noexcept {
  contacts_.clear();
  last_.clear();
  last_scale_ = 0.0;
  slippery_ = 0;
  looked_ = flat_ = false;
  started_ = ended_ = {};
  net_.forget();
  pairs_.forget();
  self_.forget();
  touch_.forget();
}

}  // namespace curtain
