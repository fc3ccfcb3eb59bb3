// SPDX-License-Identifier: BSD-3-Clause
#include "contact/obstacle_contacts.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "contact/cloth_reach.h"

namespace curtain {
namespace {

// Faces and edges are let come nearer than nodes, to this share of the thickness: few of them need a contact then.
constexpr double kCore = 0.3;
// What the cloth can move in a time, from what it moves now: so many times as fast, and faster by this acceleration [m/s^2]
// (links snapping taut give nodes hundreds).
constexpr double kFaster = 3.0;
constexpr double kAcceleration = 500.0;
// The box of the cloth holds for so many frames at most.
constexpr double kMostFrames = 16.0;

// The order in which the contacts of an obstacle are kept.
auto orderOf(const Contact& c) { return std::tie(c.nodes, c.node, c.source); }
bool firstOfOne(const Contact& a, const Contact& b) { return orderOf(a) < orderOf(b); }
bool alike(const Contact& a, const Contact& b) { return orderOf(a) == orderOf(b); }

}  // namespace

// Contacts are solved one after the other, to a tolerance: their order tells in that.
bool ObstacleContacts::before(const Contact& a, const Contact& b) const noexcept {
  return a.obstacle == b.obstacle ? firstOfOne(a, b) : obstacles_.rank(a.obstacle) < obstacles_.rank(b.obstacle);
}

ObstacleContacts::ObstacleContacts(const ClothPattern& pattern, const ContactParams& params, double frame,
                                   const ObstacleSet& obstacles)
    : pattern_(pattern),
      thickness_(params.thickness),
      recovery_speed_(params.recovery_speed),
      frame_(frame),
      obstacles_(obstacles),
      bounds_(pattern) {
  const auto count = static_cast<std::size_t>(obstacles.count());
  if (count == 0) return;
  near_.reserve(count);
  for (const MovingObstacle& moving : obstacles.moving()) near_.emplace_back(pattern, *moving.shape, thickness_, kCore * thickness_);
  active_.assign(count, 0);
  loads_.assign(count, Load());
  last_.reserve(4 * pattern.grid.nodeCount());
  crossings_.reserve(pattern.grid.nodeCount());
  carried_by_.assign(pattern.grid.size(), -1);
  carried_.reserve(pattern.grid.nodeCount());
}

// Where the cloth can be for some time; the nearer the next obstacle, the sooner it looks again.
void ObstacleContacts::lookAtCloth(const Field3& start, const Field3& predicted, double h) noexcept {
  const ClothMotion cloth = motionOfCloth(pattern_.grid, start, predicted);
  double gap = std::numeric_limits<double>::infinity();
  for (const MovingObstacle& moving : obstacles_.moving()) {
    if (!moving.present) continue;
    gap = std::min(gap, std::sqrt(cloth.box.squaredExteriorDistance(moving.sweptBounds())));
  }
  const double speed = kFaster * cloth.move / h;
  const double room = std::isfinite(gap) ? 0.5 * gap : 0.0;
  // speed t + acceleration t^2 / 2 = room
  const double time = std::min(kMostFrames * frame_, 2.0 * room / (speed + std::sqrt(speed * speed + 2.0 * kAcceleration * room) + 1e-9));
  box_ = cloth.box;
  const double margin = 2.0 * thickness_ + std::max(cloth.move, time > h ? room : 0.0);
  box_.min().array() -= margin;
  box_.max().array() += margin;
  box_time_ = std::isfinite(gap) ? time : frame_;
}

ObstacleStanding ObstacleContacts::standing(int obstacle, const Field3& position) const noexcept {
  const MovingObstacle& moving = obstacles_.moving()[static_cast<std::size_t>(obstacle)];
  if (!moving.present) return ObstacleStanding::kAbsent;
  Eigen::AlignedBox3d cloth = motionOfCloth(pattern_.grid, position, position).box;
  cloth.min().array() -= 2.0 * thickness_;
  cloth.max().array() += 2.0 * thickness_;
  return cloth.intersects(moving.sweptBounds()) ? ObstacleStanding::kNear : ObstacleStanding::kFar;
}

bool ObstacleContacts::anyWithin(const Eigen::AlignedBox3d& box) const noexcept {
  const auto is_within = [&box](const MovingObstacle& moving) {
    return moving.present && box.intersects(moving.sweptBounds());
  };
  return std::any_of(obstacles_.moving().begin(), obstacles_.moving().end(), is_within);
}

bool ObstacleContacts::mayTouch(const Field3& start, const Field3& predicted, double h) noexcept {
  std::fill(active_.begin(), active_.end(), std::uint8_t{0});
  if (!(box_time_ >= h)) {
    // Some 30 nodes will do for what is not close; where they go in the end is not where they are predicted.
    Eigen::AlignedBox3d sampled = bounds_.around(start, predicted, 1.0 + kFaster);
    sampled.min().array() -= 2.0 * thickness_;
    sampled.max().array() += 2.0 * thickness_;
    if (!anyWithin(sampled)) return false;
    lookAtCloth(start, predicted, h);
  }
  bool any = false;
  for (std::size_t n = 0; n < near_.size(); ++n) {
    const MovingObstacle& moving = obstacles_.moving()[n];
    if (!moving.present || !box_.intersects(moving.sweptBounds())) continue;
    near_[n].prepare(moving, start, predicted, h, frame_);
    active_[n] = 1;
    any = true;
  }
  return any;
}

void ObstacleContacts::collect(const Field3&, const Field3&, double h, bool slippery, Contacts& contacts) noexcept {
  slippery_ = slippery;
  const std::size_t first = contacts.size();
  for (const int index : obstacles_.byName()) {
    const auto n = static_cast<std::size_t>(index);
    if (active_[n] == 0) continue;
    const ObstacleSubstep substep = substepOf(n, h, slippery);
    collectNodes(substep, pattern_, near_[n], contacts);
    const auto elements = static_cast<std::ptrdiff_t>(contacts.size());
    if (!near_[n].faces().empty()) collectFaces(substep, pattern_, near_[n], contacts);
    if (!near_[n].pairs().empty()) collectPairs(substep, pattern_, near_[n], contacts);
    std::sort(contacts.begin() + elements, contacts.end(), firstOfOne);
    contacts.erase(std::unique(contacts.begin() + elements, contacts.end(), alike), contacts.end());
  }
  warmStart(first, contacts);
}

void ObstacleContacts::warmStart(std::size_t first, Contacts& contacts) const noexcept {
  auto old = last_.begin();
  for (std::size_t n = first; n < contacts.size(); ++n) {
    Contact& contact = contacts[n];
    while (old != last_.end() && before(*old, contact)) ++old;
    if (old == last_.end()) return;
    if (before(contact, *old)) continue;
    contact.push = old->push;
    contact.slide = old->slide;
  }
}

void ObstacleContacts::findCrossings(const Field3& start, const Field3& end, double h) noexcept {
  crossings_.clear();
  for (const int index : obstacles_.byName()) {
    const auto n = static_cast<std::size_t>(index);
    if (active_[n] == 0) continue;
    const ObstacleSubstep substep = substepOf(n, h, slippery_);
    near_[n].follow(substep.moving, start, end, h);
    crossingNodes(substep, pattern_, near_[n], crossings_);
    if (!near_[n].faces().empty()) crossingFaces(substep, pattern_, near_[n], crossings_);
    if (!near_[n].pairs().empty()) crossingPairs(substep, pattern_, near_[n], crossings_);
  }
}

int ObstacleContacts::verify(const Field3& start, const Field3& end, double h, Contacts& contacts) noexcept {
  findCrossings(start, end, h);
  for (const Crossing& crossing : crossings_) contacts.push_back(crossing.contact);
  return static_cast<int>(crossings_.size());
}

int ObstacleContacts::carry(const Field3& start, Field3& end, double h) noexcept {
  findCrossings(start, end, h);
  int count = 0;
  for (const Crossing& crossing : crossings_) {
    const MovingObstacle& moving = obstacles_.moving()[static_cast<std::size_t>(crossing.contact.obstacle)];
    bool news = false;
    for (std::size_t k = 0; k < static_cast<std::size_t>(crossing.nodes); ++k) {
      const std::uint32_t node = crossing.node[k];
      if (carried_by_[node] >= 0 || pattern_.inverse_mass[node] <= 0.0) continue;
      carried_by_[node] = crossing.contact.obstacle;
      carried_.push_back(node);
      end.set(node, moving.after.toWorld(moving.before.toLocal(start.at(node))));
      news = true;
    }
    count += news ? 1 : 0;
  }
  return count;
}

bool ObstacleContacts::carryAlong(std::size_t a, std::size_t b, const Field3& start, Field3& end) noexcept {
  if (carried_by_.empty() || (carried_by_[a] < 0) == (carried_by_[b] < 0)) return false;
  const std::size_t other = carried_by_[a] < 0 ? a : b;
  if (pattern_.inverse_mass[other] <= 0.0) return false;
  const std::int32_t obstacle = std::max(carried_by_[a], carried_by_[b]);
  const MovingObstacle& moving = obstacles_.moving()[static_cast<std::size_t>(obstacle)];
  carried_by_[other] = obstacle;
  carried_.push_back(static_cast<std::uint32_t>(other));
  end.set(other, moving.after.toWorld(moving.before.toLocal(start.at(other))));
  return true;
}

void ObstacleContacts::endCarrying() noexcept {
  for (const std::uint32_t node : carried_) carried_by_[node] = -1;
  carried_.clear();
}

void ObstacleContacts::remember(const Contacts& contacts, const Field3& position, double h, double scale) noexcept {
  last_.clear();
  box_time_ -= h;
  loaded_for_ += h;
  for (std::size_t n = 0; n < near_.size(); ++n) {
    if (active_[n] != 0) near_[n].advance(h);
    loads_[n].contacts = 0;
  }
  for (const Contact& contact : contacts) {
    if (contact.obstacle == Contact::kCloth || !contact.pushes()) continue;
    last_.push_back(contact);
    const auto obstacle = static_cast<std::size_t>(contact.obstacle);
    const Vec3 impulse = (-h / scale) * (contact.push * contact.normal + contact.slide);
    const Vec3 arm = contact.point(position) - obstacles_.moving()[obstacle].after.translation;
    loads_[obstacle].impulse += impulse;
    loads_[obstacle].angular += arm.cross(impulse);
    ++loads_[obstacle].contacts;
  }
  // What is struck may be as fast as the obstacle.
  if (!last_.empty()) box_time_ = 0.0;
  // Those that verify() added come last.
  const auto in_order = [this](const Contact& a, const Contact& b) { return before(a, b); };
  if (!std::is_sorted(last_.begin(), last_.end(), in_order)) std::sort(last_.begin(), last_.end(), in_order);
}

void ObstacleContacts::forget() noexcept {
  last_.clear();
  for (Vicinity& vicinity : near_) vicinity.forget();
  std::fill(active_.begin(), active_.end(), std::uint8_t{0});
  box_time_ = 0.0;
  beginFrame(true);
}

void ObstacleContacts::beginFrame(bool links_hold) noexcept {
  bounds_.setLinksHold(links_hold);
  std::fill(loads_.begin(), loads_.end(), Load());
  loaded_for_ = 0.0;
}

ContactWrench ObstacleContacts::wrench(int obstacle) const noexcept {
  const Load& load = loads_[static_cast<std::size_t>(obstacle)];
  if (!(loaded_for_ > 0.0)) return {};
  return {load.impulse / loaded_for_, load.angular / loaded_for_, load.contacts};
}

double ObstacleContacts::deepest(const Contacts& contacts, const Field3& position) const noexcept {
  double deepest = 0.0;
  for (const Contact& contact : contacts) {
    if (contact.obstacle == Contact::kCloth || contact.nodes > 1) continue;
    const auto obstacle = static_cast<std::size_t>(contact.obstacle);
    const Vec3 local = obstacles_.moving()[obstacle].after.toLocal(position.at(contact.node[0]));
    const NodePlane& plane = near_[obstacle].plane(contact.node[0]);
    if (plane.kind != NodePlane::Kind::kUnknown && plane.lowerBound(local) > 0.0) continue;
    SurfacePoint surface;
    if (near_[obstacle].shape().query(local, local, 0.0, surface)) deepest = std::max(deepest, -surface.distance);
  }
  return deepest;
}

}  // namespace curtain
