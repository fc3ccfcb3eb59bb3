// SPDX-License-Identifier: BSD-3-Clause
#include "contact/response/impact_zones.h"

#include "cloth/free_body.h"

namespace curtain {
ImpactZones::ImpactZones(const ClothPattern& pattern)
    : pattern_(pattern), parent_(pattern.grid.size(), kAlone), body_(pattern.grid.size(), 0) {
  members_.reserve(pattern.grid.size());
  bodies_.reserve(pattern.grid.size() / 2 + 1);
}

void ImpactZones::clear() noexcept {
  for (const std::uint32_t node : members_) parent_[node] = kAlone;
  members_.clear();
}

std::uint32_t ImpactZones::find(std::uint32_t node) noexcept {
  while (parent_[node] != node) {
    parent_[node] = parent_[parent_[node]];
    node = parent_[node];
  }
  return node;
}

std::uint32_t ImpactZones::enter(std::size_t at) noexcept {
  const auto node = static_cast<std::uint32_t>(at);
  if (parent_[node] == kAlone) {
    parent_[node] = node;
    members_.push_back(node);
  }
  return find(node);
}

void ImpactZones::join(std::size_t a, std::size_t b) noexcept {
  const std::uint32_t root_a = enter(a), root_b = enter(b);
  if (root_a != root_b) parent_[root_b] = root_a;
}

void ImpactZones::makeRigid(const Field3& start, Field3& end) noexcept {
  bodies_.clear();
  for (const std::uint32_t node : members_) {
    if (find(node) != node) continue;
    body_[node] = static_cast<std::uint32_t>(bodies_.size());
    bodies_.emplace_back();
  }
  for (const std::uint32_t node : members_) {
    Body& body = bodyOf(node);
    const double mass = pattern_.mass[node];
    const Vec3 move = end.at(node) - start.at(node);
    body.mass += mass;
    body.centre += mass * start.at(node);
    body.move += mass * move;
    if (pattern_.canMove(node)) continue;
    body.pins += 1.0;
    body.pin_move += move;
  }
  for (Body& body : bodies_) {
    body.centre /= body.mass;
    body.move = body.pins > 0.0 ? Vec3(body.pin_move / body.pins) : Vec3(body.move / body.mass);
  }
  for (const std::uint32_t node : members_) {
    Body& body = bodyOf(node);
    const double mass = pattern_.mass[node];
    const Vec3 arm = start.at(node) - body.centre;
    body.spin += mass * arm.cross(end.at(node) - start.at(node));
    body.inertia += mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  for (Body& body : bodies_) body.turn = body.pins > 0.0 ? Vec3(Vec3::Zero()) : turnOf(body.inertia, body.spin);
  for (const std::uint32_t node : members_) {
    if (!pattern_.canMove(node)) continue;
    const Body& body = bodyOf(node);
    const Vec3 from = start.at(node);
    end.set(node, from + body.move + body.turn.cross(from - body.centre));
  }
}

void ImpactZones::stop(const Field3& start, Field3& end) const noexcept {
  for (const std::uint32_t node : members_) {
    if (pattern_.canMove(node)) end.set(node, start.at(node));
  }
}

}  // namespace curtain
