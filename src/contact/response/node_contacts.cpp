// SPDX-License-Identifier: BSD-3-Clause
//
// Nodes against one obstacle. A query of a mesh takes about a microsecond: it is skipped where the cached plane shows
// that the node is far enough.
#include <algorithm>

#include "contact/narrow_phase/element_pairs.h"
#include "contact/response/element_contacts.h"
#include "contact/response/exit_direction.h"

namespace curtain {
namespace {

// Speed of depenetration inside the obstacle, over that inside the gap around it. Parts that start too close (the
// obstacle appeared or jumped) must come out slowly, not as a blow.
constexpr double kFasterInside = 20.0;
}  // namespace

double ObstacleSubstep::recoveryAt(double distance) const noexcept {
  return std::min((distance < 0.0 ? kFasterInside : 1.0) * recovery_speed * h, max_recovery);
}

double recoveredDistance(double distance, double kept, double recovery) noexcept {
  if (distance >= kept) return kept;
  const double least = (1.0 - kRestingSlack) * kept;
  return distance >= least ? distance : std::min(least, distance + recovery);
}

bool makeContact(const ObstacleSubstep& substep, const ClothPattern& pattern, const ContactPoint& point,
                 Contact& contact) noexcept {
  const MovingObstacle& moving = substep.moving;
  contact.nodes = 0;
  bool moves = false;
  for (std::size_t k = 0; k < static_cast<std::size_t>(point.nodes); ++k) {
    if (point.weight[k] == 0.0) continue;
    const auto at = static_cast<std::size_t>(contact.nodes++);
    contact.node[at] = point.node[k];
    contact.weight[at] = point.weight[k];
    moves = moves || pattern.inverse_mass[point.node[k]] > 0.0;
  }
  contact.obstacle = substep.obstacle;
  contact.normal = contact.level = moving.after.rotation * point.normal;
  contact.offset = point.height + contact.level.dot(moving.after.translation);
  contact.asked = point.asked;
  // Of a smooth shape any element has a distance; a pair of features is not one of fewer nodes.
  const bool whole = contact.nodes == point.nodes || moving.shape->features() == nullptr;
  contact.curved = point.curved && point.distance >= 0.0 && whole;
  if (contact.curved && substep.act == ContactFinder::ForcesAct::kAtStart)
    contact.normal = moving.directionAt(point.share, point.normal);
  // No friction on the way out: it could lock cloth around an edge for good.
  // A pad's is bounded by what it presses with.
  const bool frictionless = (substep.frictionless && moving.press == 0.0) || point.distance < 0.0;
  contact.friction = frictionless ? 0.0 : moving.friction;
  contact.recovery = point.recovery;
  contact.room = point.room;
  contact.anchor = moving.after.toWorld(point.start);
  contact.end_velocity = moving.motionAt(1.0, point.start) / substep.h;
  contact.surface_velocity = substep.act == ContactFinder::ForcesAct::kAtStart
                                 ? Vec3(moving.motionAt(point.share, point.touch) / substep.h)
                                 : Vec3((contact.anchor - moving.before.toWorld(point.start)) / substep.h);
  return moves;
}

namespace {

// Leapfrog's forces act along the gradient of the distance where the substep starts, or, for a node that comes from
// afar, where it gets near. With the distance at the end, that is RATTLE's constraint (Andersen 1983): sliding makes no
// energy.
Contact nodeContact(const ObstacleSubstep& substep, const ClothPattern& pattern, std::uint32_t node,
                    ObstacleCandidates& candidates, const SurfacePoint& surface, double distance, bool curved) {
  ContactPoint point;
  point.node[0] = node;
  point.weight[0] = 1.0;
  const Vec3 from = candidates.startOf(node), to = candidates.endOf(node);
  const double room = candidates.farOf(node) - candidates.thickness(), way = candidates.farOf(node) - surface.distance;
  if (room > 0.0 && way > room) point.share = room / way;
  point.start = from;
  point.touch = from + point.share * (to - from);
  point.normal = surface.normal;
  point.height = surface.normal.dot(to) - surface.distance;
  point.keep(distance, candidates.thickness(), substep);
  Contact contact;
  makeContact(substep, pattern, point, contact);
  contact.curved = curved && substep.moving.press == 0.0;
  contact.anchor_normal = contact.level;
  SurfacePoint there;
  if (!contact.curved || !candidates.surfaceOf(node, point.touch, there)) return contact;
  contact.anchor_normal = substep.moving.after.rotation * there.normal;
  if (substep.act == ContactFinder::ForcesAct::kAtStart)
    contact.normal = substep.moving.directionAt(point.share, there.normal);
  if (contact.isOf(contact.anchor_normal) || !contact.turnsAgainst(contact.level, substep.moving.after.toWorld(to)))
    return contact;
  // The face that it runs into is found in the solve.
  contact.level = contact.anchor_normal;
  if (substep.act != ContactFinder::ForcesAct::kAtStart) contact.normal = contact.level;
  contact.offset = contact.level.dot(substep.moving.after.toWorld(point.touch)) + contact.asked - there.distance;
  return contact;
}

bool touchesAtStart(const ObstacleCandidates& candidates, std::uint32_t node, SurfacePoint& surface) {
  const Vec3 from = candidates.startOf(node);
  return candidates.shape().query(from, from, candidates.nodeReach(), surface);
}

// Of nodes that a pad may hold, which end where they start: the planes are those of their start. At the end that is
// predicted without friction a node may be past the pad's edge, where the plane would push it out.
void collectHeldNodes(const ObstacleSubstep& substep, const ClothPattern& pattern, ObstacleCandidates& candidates,
                      Contacts& contacts) noexcept {
  for (const std::uint32_t node : candidates.nodes()) {
    const Vec3 from = candidates.startOf(node);
    SurfacePoint surface;
    if (candidates.isPinned(node) || !touchesAtStart(candidates, node, surface)) continue;
    const double distance = surface.distance;
    surface.distance += surface.normal.dot(candidates.endOf(node) - from);
    addWithinRoom(nodeContact(substep, pattern, node, candidates, surface, distance, false), contacts);
  }
}

}  // namespace

void collectNodes(const ObstacleSubstep& substep, const ClothPattern& pattern, ObstacleCandidates& candidates,
                  const ExitDirection& exit, const Workers& workers, Contacts& contacts) noexcept {
  const double reach = candidates.nodeReach();
  const bool pad = substep.moving.press > 0.0;
  if (pad) collectHeldNodes(substep, pattern, candidates, contacts);
  std::vector<ObstacleCandidates::NodeEnd>& ends = candidates.queryEnds(reach);
  if (pad) {
    const auto held = [&](const ObstacleCandidates::NodeEnd& end) {
      SurfacePoint at_start;
      return touchesAtStart(candidates, end.node, at_start);
    };
    ends.erase(std::remove_if(ends.begin(), ends.end(), held), ends.end());
  }
  const std::size_t before = contacts.size();
  contacts.resize(std::min(before + ends.size(), contacts.capacity()));
  workers.runChunks(contacts.size() - before, Workers::kSearchesAtOnce, [&](std::size_t first, std::size_t last) {
    for (std::size_t k = first; k < last; ++k) {
      const std::uint32_t node = ends[k].node;
      const Vec3 from = candidates.startOf(node), to = candidates.endOf(node);
      SurfacePoint& surface = ends[k].surface;
      if (surface.distance >= 0.0) candidates.seen(node) = {to, surface};
      double distance = candidates.distanceOf(node);
      const bool curved = distance >= 0.0;
      if (!curved) {
        const SurfacePoint led = exit.exitSurface(from, surface);
        if (led.normal != surface.normal) {
          distance = led.distance;
          surface = {led.distance + led.normal.dot(to - from), led.normal};
        }
      }
      contacts[before + k] = nodeContact(substep, pattern, node, candidates, surface, distance, curved);
    }
  });
}

void crossingNodes(const ObstacleSubstep& substep, const ClothPattern& pattern, ObstacleCandidates& candidates,
                   std::vector<Crossing>& crossings) noexcept {
  const double most = candidates.least();
  for (const ObstacleCandidates::NodeEnd& end : candidates.queryEnds(most)) {
    const double distance = candidates.distanceOf(end.node);
    if (distance <= 0.0 || end.surface.distance >= candidates.least(distance)) continue;
    Crossing crossing;
    crossing.node[0] = end.node;
    crossing.contact = nodeContact(substep, pattern, end.node, candidates, end.surface, distance, true);
    addWithinRoom(crossing, crossings);
  }
}

}  // namespace curtain
