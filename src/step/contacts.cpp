// SPDX-License-Identifier: BSD-3-Clause
#include "step/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "step/constants.h"
#include "step/substep.h"

namespace curtain {
namespace {

// Any orthonormal pair across the normal will do, but always the same for the same normal.
void tangents(const Vec3& normal, Vec3& first, Vec3& second) {
  int smallest = 0;
  normal.cwiseAbs().minCoeff(&smallest);
  first = normal.cross(Vec3::Unit(smallest)).normalized();
  second = normal.cross(first);
}

// Calls visit(contact's index, change of push, change of slide) for all contacts with rows: the normal's comes first.
template <typename Visit>
void forEachChange(const Rows& rows, std::size_t first, std::size_t end, const Visit& visit) {
  for (std::size_t r = first; r != end;) {
    const std::uint32_t index = rows[r].key;
    const double push = rows[r].change;
    Vec3 slide = Vec3::Zero();
    for (++r; r != end && rows[r].key == index; ++r) slide += rows[r].change * rows[r].direction;
    visit(index, push, slide);
  }
}

bool isFrictionless(const Contact& contact) noexcept {
  return contact.friction == 0.0 || contact.mobility <= 0.0 || (!contact.pushes() && contact.slide.isZero(0.0));
}

}  // namespace

void beginContacts(const Field& inverse_inertia, double scale, double ratio, std::size_t first, Contacts& contacts,
                   Field3& position) noexcept {
  for (std::size_t n = first; n < contacts.size(); ++n) {
    Contact& contact = contacts[n];
    contact.mobility = 0.0;
    for (int k = 0; k < contact.nodes; ++k) {
      const auto at = static_cast<std::size_t>(k);
      contact.mobility += contact.weight[at] * contact.weight[at] * inverse_inertia[contact.node[at]];
    }
    contact.push *= ratio;
    contact.leans = contact.push > 0.0;
    contact.hold = scale * contact.friction * contact.press;
    contact.slide = contact.boundedSlide(ratio * contact.across(contact.slide));
    contact.sticks = contact.pushes() && contact.slide.norm() < kSticksBelow * contact.maxSlide();
    if (!contact.pushes()) continue;
    if (!contact.sticks) contact.slip();
    contact.move(inverse_inertia, contact.push * contact.normal + contact.slide, position);
  }
}

double fastestSurface(const Contacts& contacts) noexcept {
  double fastest = 0.0;
  for (const Contact& contact : contacts) {
    if (contact.pushes()) fastest = std::max(fastest, contact.surface_velocity.squaredNorm());
  }
  return std::sqrt(fastest);
}

double longestStep(const Contacts& contacts, double h, double link) noexcept {
  double most = 0.0;  // of what is allowed in a substep
  for (const Contact& contact : contacts) {
    if (contact.obstacle == Contact::kCloth || !contact.pushes()) continue;
    const double motion = std::abs(h) * contact.surface_velocity.norm();
    most = std::max({most, motion / (kMaxSurfaceMotion * link), (contact.level - contact.normal).norm() / kMaxTurn});
    if (contact.curved && !contact.leans) most = std::max(most, motion / contact.asked);
  }
  return most > 0.0 ? std::abs(h) / most : std::numeric_limits<double>::infinity();
}

double fastestDrive(const Contacts& contacts, double h) noexcept {
  double fastest = fastestSurface(contacts);
  for (const Contact& contact : contacts) {
    if (contact.pushes()) fastest = std::max(fastest, contact.recovery / std::abs(h));
  }
  return fastest;
}

bool pressesOnItself(const Contacts& contacts) noexcept {
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const Contact& contact) { return contact.obstacle == Contact::kCloth && contact.pushes(); });
}

bool anyPushes(const Contacts& contacts) noexcept {
  return std::any_of(contacts.begin(), contacts.end(), [](const Contact& contact) { return contact.pushes(); });
}

bool pressesOnObstacle(const Contacts& contacts) noexcept {
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const Contact& contact) { return contact.obstacle != Contact::kCloth && contact.pushes(); });
}

void projectContacts(const Field& inverse_inertia, Contacts& contacts, Field3& position) noexcept {
  for (Contact& contact : contacts) {
    if (contact.mobility <= 0.0) continue;
    const double change = contact.boundedChange(contact.depth(position) / (contact.rise() * contact.mobility));
    contact.push += change;
    contact.move(inverse_inertia, change * contact.normal, position);
  }
  for (Contact& contact : contacts) {
    if (isFrictionless(contact)) continue;
    const Vec3 change = contact.boundedSlide(contact.wantedSlide(position)) - contact.slide;
    contact.slide += change;
    contact.move(inverse_inertia, change, position);
  }
}

void ContactRows::slide(const Field& inverse, Field3& position) noexcept {
  for (Contact& contact : *solved_) {
    // What sticks to an obstacle is held by rows of its own. Turned as well, strips that slide gained energy.
    if ((contact.sticks && contact.obstacle != Contact::kCloth) || isFrictionless(contact)) continue;
    const Vec3 wanted = contact.wantedSlide(position), change = contact.boundedSlide(wanted) - contact.slide;
    contact.slide += change;
    if (!contact.sticks || wanted.squaredNorm() > contact.maxSlide() * contact.maxSlide()) contact.slip();
    contact.move(inverse, change, position);
  }
}

void ContactRows::relinearise(const Field3& position) noexcept {
  if (finder_ != nullptr) finder_->relinearise(position, *solved_);
}

double ContactRows::residual(const Field3& position, bool recovers, double tolerance) const noexcept {
  double worst = 0.0;
  for (const Contact& contact : *all_) {
    if (contact.mobility <= 0.0) continue;  // what is held is watched on its way, by verification
    const double depth = contact.depth(position);
    if (!std::isfinite(depth)) return std::numeric_limits<double>::infinity();
    const double violation = recovers || depth < 0.0 ? depth : std::max(0.0, depth - contact.recovery);
    worst = std::max(worst, contact.pushes() ? std::abs(violation) : violation);
    if (violation > 0.0) worst = std::max(worst, violation * (tolerance / contact.room));
    if (contact.sticks)
      worst = std::max(worst, kStickShare * contact.across(contact.point(position) - contact.anchor).norm());
  }
  return worst;
}

void ContactRows::addRows(const Field3& value, bool rates, Rows& rows) const {
  for (std::uint32_t index = 0; index < all_->size(); ++index) {
    const Contact& contact = (*all_)[index];
    const Vec3 point = contact.point(value);
    const Vec3 violation = (rates ? contact.end_velocity : contact.anchor) - point;  // what the point is to move by
    const double along = rates ? contact.level.dot(violation) : contact.depth(value) / contact.rise();
    if (!contact.pushes() && (rates || !(along > 0.0))) continue;
    Row row;
    row.node = contact.node;
    row.weight = contact.weight;
    row.nodes = contact.nodes;
    row.min_damping = kMinDamping;
    if (contact.press == 0.0 && !rates) row.least = -contact.push;
    row.key = index;
    // Of a slip: n + lean on both sides, where the exact matrix has n on one. So it stays symmetric; what the slip adds
    // to the distance, or takes from it, is left to the next sweep (Acary, Cadoux, Lemarechal, Malick 2011).
    row.direction = rates ? contact.level : contact.sticks ? contact.normal : Vec3(contact.normal + contact.lean);
    row.violation = along;
    rows.push_back(row);
    if (!contact.sticks) continue;
    Vec3 first, second;
    tangents(row.direction, first, second);
    row.least = Row().least;
    for (const Vec3& tangent : {first, second}) {
      row.direction = tangent;
      row.violation = tangent.dot(violation);
      rows.push_back(row);
    }
  }
}

void ContactRows::applyChange(const Rows& rows, double share, const Field& inverse, Field3& position) noexcept {
  forEachChange(rows, first_row, end_row, [&](std::uint32_t index, double push, const Vec3& slide) {
    Contact& contact = (*solved_)[index];
    const double push_change = contact.boundedChange(share * push);
    contact.push += push_change;
    const Vec3 wanted = contact.slide + (contact.sticks ? Vec3(share * slide) : Vec3(push_change * contact.lean));
    contact.slide = wanted;
    if (!contact.sticks || wanted.squaredNorm() <= contact.maxSlide() * contact.maxSlide()) return;
    contact.slide = contact.boundedSlide(wanted);
    contact.slip();
    contact.move(inverse, contact.slide - wanted, position);
  });
}

void ContactRows::addSquares(const Field3& position, double& sum) const noexcept {
  for (const Contact& contact : *all_) {
    const double depth = contact.depth(position);
    const double relative = (depth > 0.0 || contact.pushes() ? depth : 0.0) / links_;
    sum += relative * relative;
  }
}

double ContactRows::measureRates(const Field3& velocity) noexcept {
  double worst = 0.0;
  for (const Contact& contact : *all_) {
    if (!contact.pushes()) continue;
    const Vec3 off = contact.point(velocity) - contact.end_velocity;
    worst = std::max(worst, contact.sticks ? off.norm() : std::abs(contact.level.dot(off)));
  }
  return worst / links_;
}

void ContactRows::moveBy(const Rows& rows, const Field& inverse, Field3& velocity) noexcept {
  forEachChange(rows, first_row, end_row, [&](std::uint32_t index, double push, const Vec3& slide) {
    const Vec3 impulse = push * (*all_)[index].level + slide;
    (*all_)[index].move(inverse, impulse, velocity);
    if (all_ == solved_) (*solved_)[index].settled += impulse;  // else velocities are only looked at
  });
}

void ContactRows::spread(double share, const Field& inverse, Field3& velocity) const noexcept {
  for (const Contact& contact : *all_) {
    if (contact.pushes()) contact.move(inverse, share * (contact.push * contact.level + contact.slide), velocity);
  }
}

}  // namespace curtain
