// SPDX-License-Identifier: BSD-3-Clause
#include "contact/obstacle_contacts.h"

#include <algorithm>

namespace curtain {
namespace {

// A node that is too close when the substep starts (an obstacle appeared there or jumped) is brought out at these speeds
// [m/s], not at once: the way out must not become a blow. Inside the obstacle, and inside the gap around it.
constexpr double kRecoverySpeed = 2.0;
constexpr double kGapRecoverySpeed = 0.1;

// Box around the way of all nodes.
Eigen::AlignedBox3d sweptBox(const ClothPattern& pattern, const Field3& start, const Field3& predicted) {
  Eigen::AlignedBox3d box;
  const Grid& grid = pattern.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      box.extend(start.at(grid.index(i, j)));
      box.extend(predicted.at(grid.index(i, j)));
    }
  }
  return box;
}

// The order in which contacts are found and kept.
bool before(const Contact& a, const Contact& b) {
  return a.obstacle != b.obstacle ? a.obstacle < b.obstacle : a.source < b.source;
}

}  // namespace

bool ObstacleContacts::mayTouch(const Field3& start, const Field3& predicted) noexcept {
  const Eigen::AlignedBox3d cloth = sweptBox(pattern_, start, predicted);
  // The solve may move nodes beyond their predicted way by about as much again.
  const double reach = 2.0 * thickness_ + 0.25 * cloth.diagonal().norm() / pattern_.grid.rows;
  for (const MovingObstacle& moving : obstacles_.moving()) {
    if (!moving.present) continue;
    Eigen::AlignedBox3d box = moving.sweptBounds();
    box.min().array() -= reach;
    box.max().array() += reach;
    if (box.intersects(cloth)) return true;
  }
  return false;
}

void ObstacleContacts::collect(const Field3& start, const Field3& predicted, double h, bool slippery,
                               Contacts& contacts) noexcept {
  const std::size_t first = contacts.size();
  for (int n = 0; n < obstacles_.count(); ++n) {
    if (obstacles_.present(n)) collectNodes(n, start, predicted, h, slippery, contacts);
  }
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

int ObstacleContacts::verify(const Field3&, const Field3&, double, Contacts&) noexcept { return 0; }

void ObstacleContacts::remember(const Contacts& contacts) noexcept {
  last_.clear();
  for (const Contact& contact : contacts) {
    if (contact.obstacle != Contact::kCloth && contact.pushes()) last_.push_back(contact);
  }
}

void ObstacleContacts::collectNodes(int obstacle, const Field3& start, const Field3& predicted, double h, bool slippery,
                           Contacts& contacts) const {
  const MovingObstacle& moving = obstacles_.moving()[static_cast<std::size_t>(obstacle)];
  Eigen::AlignedBox3d box = moving.sweptBounds();
  box.min().array() -= 2.0 * thickness_;
  box.max().array() += 2.0 * thickness_;
  const Grid& grid = pattern_.grid;
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t node = grid.index(i, j);
      if (pattern_.inverse_mass[node] <= 0.0) continue;
      const Vec3 from = start.at(node);
      const Vec3 to = predicted.at(node);
      if (!box.intersects(Eigen::AlignedBox3d(from.cwiseMin(to), from.cwiseMax(to)))) continue;
      SurfacePoint surface;
      const Vec3 local_from = moving.before.toLocal(from);
      const double reach = 2.0 * thickness_ + (to - from).norm();
      if (!moving.shape->query(local_from, moving.after.toLocal(to), reach, surface)) continue;
      Contact contact;
      contact.node[0] = static_cast<std::uint32_t>(node);
      contact.weight[0] = 1.0;
      contact.obstacle = obstacle;
      contact.normal = moving.after.rotation * surface.normal;
      contact.offset = contact.normal.dot(to) - surface.distance + thickness_;
      contact.friction = slippery ? 0.0 : moving.friction;
      SurfacePoint before;
      if (moving.shape->query(local_from, local_from, thickness_, before)) {
        const double speed = before.distance < 0.0 ? kRecoverySpeed : kGapRecoverySpeed;
        contact.offset -= std::max(0.0, thickness_ - before.distance - speed * h);
        // Nothing holds a node back on its way out: friction there could lock cloth around an edge for good.
        if (before.distance < 0.0) contact.friction = 0.0;
      }
      contact.carried = moving.after.toWorld(local_from);
      contact.surface_velocity = (contact.carried - from) / h;
      contact.source = contact.node[0];
      contacts.push_back(contact);
    }
  }
}

double ObstacleContacts::deepest(const Contacts& contacts, const Field3& position) const noexcept {
  double deepest = 0.0;
  for (const Contact& contact : contacts) {
    if (contact.obstacle == Contact::kCloth || contact.nodes > 1) continue;
    const MovingObstacle& moving = obstacles_.moving()[static_cast<std::size_t>(contact.obstacle)];
    const Vec3 local = moving.after.toLocal(position.at(contact.node[0]));
    SurfacePoint surface;
    if (moving.shape->query(local, local, 0.0, surface)) deepest = std::max(deepest, -surface.distance);
  }
  return deepest;
}

}  // namespace curtain
