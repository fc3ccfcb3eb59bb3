// SPDX-License-Identifier: BSD-3-Clause
#include "contact/cloth_contact.h"

#include <algorithm>

namespace curtain {
namespace {

// Substeps without friction after one whose links could not be brought to their lengths.
constexpr int kSlipperySubsteps = 64;

// Box around the way of all free nodes.
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

ClothContact::ClothContact(const ClothPattern& pattern, const ContactParams& params, const ObstacleSet& obstacles)
    : pattern_(pattern), obstacles_(obstacles), nodes_(pattern, params.thickness, obstacles), thickness_(params.thickness) {
  if (obstacles.count() > 0) {
    contacts_.reserve(4 * pattern.grid.nodeCount());
    last_.reserve(4 * pattern.grid.nodeCount());
  }
}

Contacts* ClothContact::begin(const ClothPattern&, const Field3& start, const Field3& predicted, double h) noexcept {
  contacts_.clear();
  if (!obstacles_.anyPresent()) return nullptr;
  const Eigen::AlignedBox3d cloth = sweptBox(pattern_, start, predicted);
  // The solve may move nodes beyond their predicted way by about as much again.
  const double reach = 2.0 * thickness_ + 0.25 * cloth.diagonal().norm() / pattern_.grid.rows;
  for (int n = 0; n < obstacles_.count(); ++n) {
    const MovingObstacle& moving = obstacles_.moving()[static_cast<std::size_t>(n)];
    if (!moving.present) continue;
    Eigen::AlignedBox3d box = moving.sweptBounds();
    box.min().array() -= reach;
    box.max().array() += reach;
    if (box.intersects(cloth)) nodes_.collect(n, start, predicted, h, slippery_ > 0, contacts_);
  }
  recall();
  return contacts_.empty() ? nullptr : &contacts_;
}

// The multipliers of the last substep, for the contacts that are the same.
void ClothContact::recall() noexcept {
  auto old = last_.begin();
  for (Contact& contact : contacts_) {
    while (old != last_.end() && before(*old, contact)) ++old;
    if (old == last_.end()) return;
    if (before(contact, *old)) continue;
    contact.push = old->push;
    contact.slide = old->slide;
  }
}

ContactFinder::Verdict ClothContact::verify(const Field3&, const Field3&) noexcept { return Verdict::kClear; }
void ClothContact::hold(const Field3&, Field3&) noexcept {}

void ClothContact::afterSubstep(bool settled, const Field& inverse_inertia, double scale) noexcept {
  if (!settled) slippery_ = kSlipperySubsteps;
  else if (slippery_ > 0) --slippery_;
  last_.clear();
  for (const Contact& contact : contacts_) {
    if (contact.pushes()) last_.push_back(contact);
  }
  last_scale_ = scale;
  static_cast<void>(inverse_inertia);
}

int ClothContact::contactCount() const noexcept { return static_cast<int>(last_.size()); }

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
}

}  // namespace curtain
