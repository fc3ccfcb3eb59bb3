// SPDX-License-Identifier: BSD-3-Clause
//
// Nodes against one obstacle. A query of a mesh costs about a microsecond: it is left out where the plane that was last
// found shows that the node is far enough.
#include <algorithm>

#include "contact/narrow_phase/candidates.h"
#include "contact/response/common_exit.h"
#include "contact/response/obstacle_touch.h"

namespace curtain {
namespace {

// What is too close when a substep starts (an obstacle appeared there or jumped) is brought out slowly, not at once:
// the way out must not become a blow. Inside the obstacle so many times as fast as inside the gap around it.
constexpr double kFasterInside = 20.0;
// Share of what is to be kept that may lack.
constexpr double kSlack = 0.1;

}  // namespace

double letOut(double distance, double kept, const ObstacleSubstep& substep) noexcept {
  if (distance >= kept) return kept;
  const double least = (1.0 - kSlack) * kept;
  if (distance >= least) return distance;
  const double speed = distance < 0.0 ? kFasterInside * substep.recovery_speed : substep.recovery_speed;
  return std::min(least, distance + std::min(speed * substep.h, substep.most_recovery));
}

bool makeContact(const ObstacleSubstep& substep, const ClothPattern& pattern, const TouchPoint& point,
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
  contact.normal = moving.after.rotation * point.normal;
  contact.offset = point.height + contact.normal.dot(moving.after.translation);
  // Nothing holds a node back on its way out: friction there could lock cloth around an edge for good.
  contact.friction = substep.slippery || point.distance < 0.0 ? 0.0 : moving.friction;
  contact.recovery = point.recovery;
  contact.carried = moving.after.toWorld(point.start);
  contact.surface_velocity = (contact.carried - moving.before.toWorld(point.start)) / substep.h;
  return moves;
}

namespace {

Contact nodeContact(const ObstacleSubstep& substep, const ClothPattern& pattern, std::uint32_t node,
                    const Vicinity& near, const SurfacePoint& surface, double distance) {
  TouchPoint point;
  point.node[0] = node;
  point.weight[0] = 1.0;
  point.start = near.startOf(node);
  point.normal = surface.normal;
  point.height = surface.normal.dot(near.endOf(node)) - surface.distance;
  point.keep(distance, near.thickness(), substep);
  Contact contact;
  makeContact(substep, pattern, point, contact);
  return contact;
}

}  // namespace

void collectNodes(const ObstacleSubstep& substep, const ClothPattern& pattern, Vicinity& near, const CommonExit& exit,
                  Contacts& contacts) noexcept {
  const double reach = near.nodeReach();
  for (Vicinity::NodeEnd& end : near.lookAtEnds(reach)) {
    const std::uint32_t node = end.node;
    const Vec3 from = near.startOf(node), to = near.endOf(node);
    SurfacePoint& surface = end.surface;
    if (surface.distance >= 0.0) near.plane(node) = {to, surface, NodePlane::Kind::kFound};
    double distance = near.distanceOf(node);
    if (distance < 0.0) {
      const SurfacePoint led = exit.lead(from, surface);
      if (led.normal != surface.normal) {
        distance = led.distance;
        surface = {led.distance + led.normal.dot(to - from), led.normal};
      }
    }
    addWithinRoom(nodeContact(substep, pattern, node, near, surface, distance), contacts);
  }
}

void crossingNodes(const ObstacleSubstep& substep, const ClothPattern& pattern, Vicinity& near,
                   std::vector<Crossing>& crossings) noexcept {
  const double most = Vicinity::kLeast * near.thickness();
  for (const Vicinity::NodeEnd& end : near.lookAtEnds(most)) {
    const double distance = near.distanceOf(end.node);
    if (distance <= 0.0 || end.surface.distance >= std::min(most, 0.5 * distance)) continue;
    Crossing crossing;
    crossing.node[0] = end.node;
    crossing.contact = nodeContact(substep, pattern, end.node, near, end.surface, distance);
    addWithinRoom(crossing, crossings);
  }
}

}  // namespace curtain
