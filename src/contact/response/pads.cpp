// SPDX-License-Identifier: BSD-3-Clause
#include "contact/response/pads.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "contact/response/element_contacts.h"

namespace curtain {
namespace {

// How far a point is above the plane that a contact holds it to [m].
double roomOf(const Contact& contact, const Vec3& point) { return contact.normal.dot(point) - contact.offset; }

}  // namespace

Pads::Pads(const ClothPattern& pattern, const ObstacleSet& obstacles, double thickness)
    : pattern_(pattern), obstacles_(obstacles), max_play_(2.0 * kRestingSlack * thickness) {
  std::size_t pads = 0;
  for (int n = 0; n < obstacles.count(); ++n) pads += obstacles.press(n) > 0.0 ? 1 : 0;
  if (pads < 2) return;
  touches_.reserve(pads * pattern.grid.nodeCount());
  pairs_.reserve(pattern.grid.nodeCount());
  pinched_.assign(static_cast<std::size_t>(obstacles.count()), 0.0);
}

bool Pads::closes(const Contact& a, const Contact& b) const noexcept {
  const double turned = std::acos(std::min(1.0, std::max(-1.0, -a.normal.dot(b.normal))));
  if (turned > std::atan(a.friction) + std::atan(b.friction)) return false;
  return roomOf(a, a.anchor) + roomOf(b, a.anchor) <= max_play_;
}

void Pads::pinch(Contacts& contacts) noexcept {
  if (pinched_.empty()) return;
  touches_.clear();
  for (std::size_t n = 0; n < contacts.size(); ++n) {
    const Contact& contact = contacts[n];
    if (contact.obstacle == Contact::kCloth || contact.nodes != 1 || contact.friction <= 0.0) continue;
    if (pressOf(contact) > 0.0 && touches_.size() < touches_.capacity()) touches_.push_back({contact.node[0], n});
  }
  std::sort(touches_.begin(), touches_.end(),
            [](const Touch& a, const Touch& b) { return std::tie(a.node, a.contact) < std::tie(b.node, b.contact); });
  pairs_.clear();
  std::fill(pinched_.begin(), pinched_.end(), 0.0);
  for (std::size_t t = 1; t < touches_.size(); ++t) {
    const Contact &a = contacts[touches_[t - 1].contact], &b = contacts[touches_[t].contact];
    if (touches_[t - 1].node != touches_[t].node || !closes(a, b)) continue;
    if (!pairs_.empty() && pairs_.back().second == touches_[t - 1].contact) continue;  // pinched already
    pairs_.push_back({touches_[t - 1].contact, touches_[t].contact});
    for (const Contact* side : {&a, &b}) pinched_[static_cast<std::size_t>(side->obstacle)] += pattern_.area[a.node[0]];
  }
  for (const Pair& pair : pairs_) {
    Contact &a = contacts[pair.first], &b = contacts[pair.second];
    const auto share = [&](const Contact& side) {
      return pressOf(side) * pattern_.area[a.node[0]] / pinched_[static_cast<std::size_t>(side.obstacle)];
    };
    a.press = std::min(share(a), share(b));
    a.friction += b.friction;
    a.other = b.obstacle;
    a.surface_velocity = 0.5 * (a.surface_velocity + b.surface_velocity);
    a.end_velocity = 0.5 * (a.end_velocity + b.end_velocity);
    a.anchor = 0.5 * (a.anchor + b.anchor);
    // It stays where it is between them, as far as both leave it room, else in the middle.
    const double room_a = roomOf(a, a.anchor), room_b = roomOf(b, a.anchor);
    const Vec3 across = (a.normal - b.normal).normalized();
    const double per_distance = 1.0 / a.normal.dot(across), low = -room_a * per_distance, high = room_b * per_distance;
    const double way = low > high ? 0.5 * (low + high) : std::min(high, std::max(low, 0.0));
    a.normal = a.level = across;
    a.offset = across.dot(a.anchor) + way;
    a.recovery = 0.0;
    b.node[0] = Contact::kNowhere;
  }
  const auto joined = [](const Contact& contact) { return contact.node[0] == Contact::kNowhere; };
  contacts.erase(std::remove_if(contacts.begin(), contacts.end(), joined), contacts.end());
}

}  // namespace curtain
