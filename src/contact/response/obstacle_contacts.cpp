// SPDX-License-Identifier: BSD-3-Clause
#include "contact/response/obstacle_contacts.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "contact/narrow_phase/element_pairs.h"

namespace curtain {
namespace {

// Gap of faces and edges, over the thickness: smaller than that of nodes, so that few of them need contacts.
constexpr double kCore = 0.3;
// Contacts of one obstacle go by the parts of the cloth that touch, then by what a mirror keeps: it would number the
// features of a box otherwise.
bool before(const Contact& a, const Contact& b) {
  return std::tie(a.nodes, a.node, a.offset, a.weight, a.source) <
         std::tie(b.nodes, b.node, b.offset, b.weight, b.source);
}

// Both faces of an edge find what touches it: of each the first is kept.
void dropDuplicates(Contacts& contacts, std::size_t first) noexcept {
  std::size_t kept = first, group = first;
  for (std::size_t n = first; n < contacts.size(); ++n) {
    const Contact& contact = contacts[n];
    if (kept > group && std::tie(contact.nodes, contact.node) != std::tie(contacts[group].nodes, contacts[group].node))
      group = kept;
    bool known = false;
    for (std::size_t k = group; k < kept; ++k) known = known || contacts[k].source == contact.source;
    if (!known) contacts[kept++] = contact;
  }
  contacts.erase(contacts.begin() + static_cast<std::ptrdiff_t>(kept), contacts.end());
}

}  // namespace

ObstacleContacts::ObstacleContacts(const ClothPattern& pattern, const ContactParams& params, ObstacleSet& obstacles,
                                   const Workers& workers)
    : pattern_(pattern),
      workers_(workers),
      thickness_(params.thickness),
      recovery_speed_(params.recovery_speed),
      obstacles_(obstacles),
      pads_(pattern, obstacles, thickness_),
      bounds_(pattern) {
  const auto count = static_cast<std::size_t>(obstacles.count());
  if (count == 0) return;
  candidates_.reserve(count);
  for (int n = 0; n < obstacles.count(); ++n)
    candidates_.emplace_back(pattern, obstacles.shape(n),
                             ObstacleGaps{thickness_, kCore * thickness_, obstacles.padding(n)}, workers);
  active_.assign(count, 0);
  loads_.assign(count, Load());
  crossings_.reserve(pattern.grid.nodeCount());
  penetrating_.reserve(2 * pattern.grid.nodeCount());
  advected_by_.assign(pattern.grid.size(), -1);
  advected_.reserve(pattern.grid.nodeCount());
  held_.reserve(pattern.grid.nodeCount());
  met_another_.reserve(kRoomPerNode * pattern.grid.nodeCount());
}

// The box grown by what may touch beyond it.
Eigen::AlignedBox3d ObstacleContacts::reached(Eigen::AlignedBox3d box) const noexcept {
  const double margin = 2.0 * thickness_;
  box.min().array() -= margin;
  box.max().array() += margin;
  return box;
}

ObstacleStanding ObstacleContacts::standing(int obstacle, const Field3& position) const noexcept {
  if (!obstacles_.present(obstacle)) return ObstacleStanding::kAbsent;
  const Eigen::AlignedBox3d box = reached(boxAround(pattern_.grid, position, position));
  const bool near = box.intersects(obstacles_.moving(obstacle).sweptBounds());
  return near ? ObstacleStanding::kNear : ObstacleStanding::kFar;
}

bool ObstacleContacts::anyWithin(const Eigen::AlignedBox3d& box) const noexcept {
  const std::vector<int>& near = obstacles_.near(box);
  return std::any_of(near.begin(), near.end(), [&](int n) { return obstacles_.mayMeet(n, box); });
}

void ObstacleContacts::begin(const Field3& start, const Field3& predicted, const Begin& begin,
                             Contacts& contacts) noexcept {
  h_ = begin.h;
  act_ = begin.act;
  frictionless_ = begin.frictionless;
  held_.clear();
  begun_ = contacts.size();
  std::fill(active_.begin(), active_.end(), std::uint8_t{0});
  if (obstacles_.sweptBounds().isEmpty()) return;
  start_box_ = bounds_.around(start);
  if (!activate(start, predicted, true)) return;
  for (const int index : obstacles_.byName()) {
    const auto n = static_cast<std::size_t>(index);
    if (active_[n] == 0) continue;
    const ObstacleSubstep substep = substepOf(n);
    const std::size_t first = contacts.size();
    penetrating_.clear();
    if (!candidates_[n].faces().empty()) collectFaces(substep, pattern_, candidates_[n], penetrating_, contacts);
    if (!candidates_[n].pairs().empty()) collectPairs(substep, pattern_, candidates_[n], contacts);
    const ExitDirection exit(pattern_.grid, candidates_[n], penetrating_);
    collectPenetratingFaces(substep, pattern_, candidates_[n], exit, penetrating_, contacts);
    collectNodes(substep, pattern_, candidates_[n], exit, workers_, contacts);
    std::sort(contacts.begin() + static_cast<std::ptrdiff_t>(first), contacts.end(), before);
    dropDuplicates(contacts, first);
  }
  pads_.pinch(contacts);
  begun_ = contacts.size();
}

// Where a contact's plane is now: false if it stays. What neither pushes nor is below its last plane has none to find:
// that plane bounds what is convex, a feature of a mesh too. Of a node and a whole mesh the distance that it saw last
// does. That of an edge or a face is set at once.
bool ObstacleContacts::findSurface(const Field3& position, Contact& contact, SurfacePoint& surface) noexcept {
  if (!contact.curved || contact.ran_into) return false;
  ObstacleCandidates& candidates = candidates_[static_cast<std::size_t>(contact.obstacle)];
  const bool convex = contact.nodes > 1 || candidates.shape().convex() != nullptr;
  if (convex && !contact.pushes() && contact.isAbove(position)) return false;
  const Transform& place = obstacles_.moving(contact.obstacle).after;
  if (contact.nodes > 1) {
    curtain::relinearise(candidates.shape(), place, position, contact);
    return false;
  }
  const std::uint32_t node = contact.node[0];
  const Vec3 at = place.toLocal(position.at(node));
  if (!contact.pushes() && candidates.seen(node).lowerBound(at) > contact.asked) return false;
  if (!candidates.surfaceOf(node, at, surface)) return false;
  surface.normal = place.rotation * surface.normal;
  return true;
}

// The distance at the end, not that to a plane of before: a node that slides around an edge follows it. Of those that
// the substep began with a node has one contact with an obstacle, and each is turned by itself, but where it has met
// another face.
void ObstacleContacts::relinearise(const Field3& position, Contacts& contacts) noexcept {
  if (candidates_.empty()) return;
  const std::size_t count = contacts.size();
  met_another_.assign(begun_, 0);
  workers_.runChunks(begun_, Workers::kSearchesAtOnce, [&](std::size_t first, std::size_t end) {
    for (std::size_t n = first; n < end; ++n) {
      SurfacePoint surface;
      if (!findSurface(position, contacts[n], surface)) continue;
      if (contacts[n].isOf(surface.normal))
        contacts[n].turnTo(surface.normal, surface.distance, position);
      else
        met_another_[n] = 1;
    }
  });
  for (std::size_t n = 0; n < count; ++n) {
    if (n < begun_ && met_another_[n] == 0) continue;
    SurfacePoint surface;
    if (!findSurface(position, contacts[n], surface)) continue;
    faceMet(contacts[n], surface, position, contacts).turnTo(surface.normal, surface.distance, position);
  }
}

// A node's contact with the face that is nearest to it now, of its first one and those of faces that it ran into. May
// be a new one.
Contact& ObstacleContacts::faceMet(Contact& first, const SurfacePoint& surface, const Field3& position,
                                   Contacts& contacts) noexcept {
  if (first.isOf(surface.normal)) return first;
  for (std::size_t k = begun_; k < contacts.size(); ++k) {
    Contact& other = contacts[k];
    if (other.ran_into && other.node == first.node && other.obstacle == first.obstacle && other.isOf(surface.normal))
      return other;
  }
  if (!first.runsInto(surface.normal, position.at(first.node[0]))) return first;
  Contact other = first;
  other.ran_into = true;
  other.normal = other.level = surface.normal;
  other.push = 0.0;
  other.slide = other.lean = other.settled = Vec3::Zero();
  other.sticks = other.leans = false;
  return addWithinRoom(other, contacts) ? contacts.back() : first;
}

// Finds candidates for the motion from start to end of every obstacle near it, which become active; false: none is
// near. As long as links hold, a box around some 30 nodes rejects far obstacles.
bool ObstacleContacts::activate(const Field3& start, const Field3& end, bool links_hold) noexcept {
  if (obstacles_.sweptBounds().isEmpty()) return false;
  if (links_hold) {
    const Vec3 displacement = Vec3::Constant(bounds_.farthest(start, end));
    const Eigen::AlignedBox3d box = reached({start_box_.min() - displacement, start_box_.max() + displacement});
    if (!box.intersects(obstacles_.sweptBounds()) || !anyWithin(box)) return false;
  }
  const Eigen::AlignedBox3d box = reached(boxAround(pattern_.grid, start, end));
  bool any = false;
  for (std::size_t n = 0; n < candidates_.size(); ++n) {
    if (active_[n] == 0 && !obstacles_.mayMeet(static_cast<int>(n), box)) continue;
    const MovingObstacle& obstacle = moving(n);
    if (active_[n] == 0 && !box.intersects(obstacle.sweptBounds())) continue;
    if (active_[n] != 0)
      candidates_[n].follow(obstacle, end);
    else
      candidates_[n].prepare(obstacle, start, end);
    active_[n] = 1;
    any = true;
  }
  return any;
}

void ObstacleContacts::findCrossings(const Field3& start, const Field3& end, bool links_hold) noexcept {
  crossings_.clear();
  full_ = false;
  if (!activate(start, end, links_hold)) return;
  for (const int index : obstacles_.byName()) {
    const auto n = static_cast<std::size_t>(index);
    if (active_[n] == 0) continue;
    const ObstacleSubstep substep = substepOf(n);
    crossingNodes(substep, pattern_, candidates_[n], crossings_);
    const auto elements = static_cast<std::ptrdiff_t>(crossings_.size());
    if (!candidates_[n].faces().empty()) crossingFaces(substep, pattern_, candidates_[n], crossings_);
    if (!candidates_[n].pairs().empty()) crossingPairs(substep, pattern_, candidates_[n], crossings_);
    std::sort(crossings_.begin() + elements, crossings_.end(), [](const Crossing& a, const Crossing& b) {
      return a.node != b.node ? a.node < b.node : before(a.contact, b.contact);
    });
    full_ = full_ || candidates_[n].full();
  }
}

int ObstacleContacts::verify(const Field3& start, const Field3& end, bool links_hold, Contacts& contacts) noexcept {
  findCrossings(start, end, links_hold);
  for (const Crossing& crossing : crossings_) addWithinRoom(crossing.contact, contacts);
  return static_cast<int>(crossings_.size());
}

int ObstacleContacts::advect(const Field3& start, Field3& end) noexcept {
  findCrossings(start, end, false);
  int count = 0;
  for (const Crossing& crossing : crossings_) {
    bool found_new = false;
    for (std::size_t k = 0; k < static_cast<std::size_t>(crossing.nodes); ++k) {
      found_new = advectNode(crossing.node[k], crossing.contact.obstacle, start, end) || found_new;
    }
    count += found_new ? 1 : 0;
  }
  return count;
}

// False: it moves with an obstacle already, is pinned, or held.
bool ObstacleContacts::advectNode(std::uint32_t node, int obstacle, const Field3& start, Field3& end) noexcept {
  if (advected_by_[node] >= 0 || !pattern_.canMove(node)) return false;
  const MovingObstacle& moving = obstacles_.moving(obstacle);
  advected_by_[node] = obstacle;
  advected_.push_back(node);
  const Vec3 to = moving.after.toWorld(moving.before.toLocal(start.at(node)));
  held_.push_back({node, obstacle, (pattern_.mass[node] / h_) * (end.at(node) - to)});
  end.set(node, to);
  return true;
}

bool ObstacleContacts::advectAlong(std::size_t a, std::size_t b, const Field3& start, Field3& end) noexcept {
  if (advected_by_.empty() || (advected_by_[a] < 0) == (advected_by_[b] < 0)) return false;
  return advectNode(static_cast<std::uint32_t>(advected_by_[a] < 0 ? a : b), std::max(advected_by_[a], advected_by_[b]),
                    start, end);
}

void ObstacleContacts::freezeRest(const Field3& start, Field3& end) const noexcept {
  for (std::size_t n = 0; n < pattern_.grid.size(); ++n) {
    if (advected_by_[n] < 0 && pattern_.canMove(n)) end.set(n, start.at(n));
  }
}

void ObstacleContacts::endAdvection() noexcept {
  for (const std::uint32_t node : advected_) advected_by_[node] = -1;
  advected_.clear();
}

void ObstacleContacts::remember(const Contacts& contacts, const Field3& position,
                                const SubstepOutcome& outcome) noexcept {
  acted_ += outcome.kick;
  for (Load& load : loads_) load.contacts = 0;
  for (const Contact& contact : contacts) {
    if (contact.obstacle == Contact::kCloth || (!contact.pushes() && contact.slide.isZero(0.0))) continue;
    const Vec3 point = contact.point(position);
    const Vec3 impulse =
        (-outcome.kick / outcome.scale) * (contact.push * contact.normal + contact.slide) - contact.settled;
    if (contact.other == Contact::kCloth) {
      addLoad(contact.obstacle, point, impulse, contact.pushes());
    } else {
      const Vec3 pressed = (outcome.kick * contact.press) * contact.normal;
      addLoad(contact.obstacle, point, 0.5 * impulse - pressed, true);
      addLoad(contact.other, point, 0.5 * impulse + pressed, true);
    }
  }
  addHeld(position, outcome);
}

void ObstacleContacts::addHeld(const Field3& position, const SubstepOutcome& outcome) noexcept {
  if (outcome.share == 0.0) return;  // the path on which they were taken along was given up
  for (const Held& held : held_) addLoad(held.obstacle, position.at(held.node), held.impulse, false);
}

void ObstacleContacts::addLoad(int obstacle, const Vec3& point, const Vec3& impulse, bool pushes) noexcept {
  Load& load = loads_[static_cast<std::size_t>(obstacle)];
  load.impulse += impulse;
  load.angular += (point - obstacles_.moving(obstacle).after.translation).cross(impulse);
  load.contacts += pushes ? 1 : 0;
}

void ObstacleContacts::clearCaches() noexcept {
  for (ObstacleCandidates& candidates : candidates_) candidates.invalidate();
}

void ObstacleContacts::beginFrame(bool links_hold) noexcept {
  bounds_.setLinksHold(links_hold);
  std::fill(loads_.begin(), loads_.end(), Load());
  acted_ = 0.0;
}

ContactWrench ObstacleContacts::wrench(int obstacle) const noexcept {
  const Load& load = loads_[static_cast<std::size_t>(obstacle)];
  if (!(acted_ > 0.0)) return {};
  return {load.impulse / acted_, load.angular / acted_, load.contacts, acted_};
}

double ObstacleContacts::deepest(const Contacts& contacts, const Field3& position) const noexcept {
  double deepest = 0.0;
  for (const Contact& contact : contacts) {
    if (contact.obstacle == Contact::kCloth || contact.nodes > 1) continue;
    const auto obstacle = static_cast<std::size_t>(contact.obstacle);
    const Vec3 local = moving(obstacle).after.toLocal(position.at(contact.node[0]));
    if (candidates_[obstacle].seen(contact.node[0]).lowerBound(local) > 0.0) continue;
    SurfacePoint surface;
    if (candidates_[obstacle].shape().query(local, local, 0.0, surface)) deepest = std::max(deepest, -surface.distance);
  }
  return deepest;
}

}  // namespace curtain
