// SPDX-License-Identifier: BSD-3-Clause
#include "step/contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "step/constants.h"

namespace curtain {
namespace {

Vec3 across(const Vec3& normal, const Vec3& v) { return v - normal.dot(v) * normal; }

// Projection on Coulomb's disc.
Vec3 bounded(const Vec3& slide, double most) {
  const double size = slide.norm();
  return size > most ? Vec3(slide * (most / size)) : slide;
}

// Any orthonormal pair across the normal will do, but always the same for the same normal.
void tangents(const Vec3& normal, Vec3& first, Vec3& second) {
  int smallest = 0;
  normal.cwiseAbs().minCoeff(&smallest);
  first = normal.cross(Vec3::Unit(smallest)).normalized();
  second = normal.cross(first);
}

// The normal's row comes first. lacks: what the point is to move by, along the normal and, where it sticks, across.
void addRowsOf(const Contact& contact, std::uint32_t index, double along, const Vec3& lacks, Rows& rows) {
  Row row;
  row.node = contact.node;
  row.weight = contact.weight;
  row.nodes = contact.nodes;
  row.least_damping = kLeastDamping;
  row.key = index;
  row.direction = contact.normal;
  row.violation = along;
  rows.push_back(row);
  if (!contact.sticks) return;
  Vec3 first, second;
  tangents(contact.normal, first, second);
  for (const Vec3& tangent : {first, second}) {
    row.direction = tangent;
    row.violation = tangent.dot(lacks);
    rows.push_back(row);
  }
}

// Calls take(contact's index, change of push, change of slide) for all contacts with rows.
template <typename Take>
void forEachChange(RowRange rows, const Take& take) {
  for (const Row* row = rows.first; row != rows.last;) {
    const std::uint32_t index = row->key;
    const double push = row->change;
    Vec3 slide = Vec3::Zero();
    for (++row; row != rows.last && row->key == index; ++row) slide += row->change * row->direction;
    take(index, push, slide);
  }
}

// Adds changes to a contact's multipliers.
void takeUp(const Field& inverse_inertia, double push, const Vec3& slide, Contact& contact, Field3& position) {
  const double push_change = contact.boundedChange(push);
  contact.push += push_change;
  Vec3 slide_change = slide;
  const double most = contact.mostSlide();
  const Vec3 wanted = contact.slide + slide;
  if (contact.sticks && wanted.squaredNorm() > most * most) {
    slide_change = bounded(wanted, most) - contact.slide;
    contact.sticks = false;
  }
  contact.slide += slide_change;
  contact.move(inverse_inertia, push_change * contact.normal + slide_change, position);
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
    contact.hold = scale * contact.friction * contact.press;
    contact.slide = bounded(ratio * across(contact.normal, contact.slide), contact.mostSlide());
    contact.sticks = contact.pushes() && contact.slide.norm() < kSticksBelow * contact.mostSlide();
    if (!contact.pushes()) continue;
    contact.move(inverse_inertia, contact.push * contact.normal + contact.slide, position);
  }
}

double contactResidual(const Contacts& contacts, const Field3& position, bool recovers) noexcept {
  double worst = 0.0;
  for (const Contact& contact : contacts) {
    const Vec3 point = contact.point(position);
    const double entered = contact.offset - contact.normal.dot(point);
    if (!std::isfinite(entered)) return std::numeric_limits<double>::infinity();
    const double lacks = recovers || entered < 0.0 ? entered : std::max(0.0, entered - contact.recovery);
    worst = std::max(worst, contact.pushes() ? std::abs(lacks) : lacks);
    if (contact.sticks) worst = std::max(worst, kStickShare * across(contact.normal, point - contact.carried).norm());
  }
  return worst;
}

double contactRate(const Contacts& contacts, const Field3& velocity) noexcept {
  double worst = 0.0;
  for (const Contact& contact : contacts) {
    if (!contact.pushes()) continue;
    const Vec3 off = contact.point(velocity) - contact.surface_velocity;
    worst = std::max(worst, contact.sticks ? off.norm() : std::abs(contact.normal.dot(off)));
  }
  return worst;
}

double fastestSurface(const Contacts& contacts) noexcept {
  double fastest = 0.0;
  for (const Contact& contact : contacts) {
    if (contact.pushes()) fastest = std::max(fastest, contact.surface_velocity.squaredNorm());
  }
  return std::sqrt(fastest);
}

double fastestDrive(const Contacts& contacts, const Field3& start, double h) noexcept {
  double fastest = fastestSurface(contacts);
  for (const Contact& contact : contacts) {
    if (contact.pushes())
      fastest = std::max(fastest, (contact.offset - contact.normal.dot(contact.point(start))) / std::abs(h));
  }
  return fastest;
}

bool anyPushes(const Contacts& contacts) noexcept {
  return std::any_of(contacts.begin(), contacts.end(), [](const Contact& contact) { return contact.pushes(); });
}

bool pressesOnObstacle(const Contacts& contacts) noexcept {
  return std::any_of(contacts.begin(), contacts.end(),
                     [](const Contact& contact) { return contact.obstacle != Contact::kCloth && contact.pushes(); });
}

void projectFriction(const Field& inverse_inertia, Contacts& contacts, Field3& position) noexcept {
  for (Contact& contact : contacts) {
    if (contact.sticks || contact.friction == 0.0 || contact.mobility <= 0.0) continue;
    if (!contact.pushes() && contact.slide.squaredNorm() == 0.0) continue;
    const Vec3 slip = across(contact.normal, contact.point(position) - contact.carried);
    const double most = contact.mostSlide();
    const Vec3 wanted = contact.slide - slip / contact.mobility;
    const Vec3 change = bounded(wanted, most) - contact.slide;
    contact.slide += change;
    contact.move(inverse_inertia, change, position);
  }
}

void addContactRows(const Contacts& contacts, const Field3& position, Rows& rows) {
  for (std::uint32_t index = 0; index < contacts.size(); ++index) {
    const Contact& contact = contacts[index];
    const Vec3 point = contact.point(position);
    const double entered = contact.offset - contact.normal.dot(point);
    if (contact.pushes() || entered > 0.0) addRowsOf(contact, index, entered, contact.carried - point, rows);
  }
}

void addContactRateRows(const Contacts& contacts, const Field3& velocity, Rows& rows) {
  for (std::uint32_t index = 0; index < contacts.size(); ++index) {
    const Contact& contact = contacts[index];
    if (!contact.pushes()) continue;
    const Vec3 lacks = contact.surface_velocity - contact.point(velocity);
    addRowsOf(contact, index, contact.normal.dot(lacks), lacks, rows);
  }
}

void takeUpContacts(const Field& inverse_inertia, RowRange rows, double share, Contacts& contacts,
                    Field3& position) noexcept {
  forEachChange(rows, [&](std::uint32_t index, double push, const Vec3& slide) {
    takeUp(inverse_inertia, share * push, share * slide, contacts[index], position);
  });
}

void moveByContacts(const Field& inverse_inertia, RowRange rows, const Contacts& contacts, Field3& velocity) noexcept {
  forEachChange(rows, [&](std::uint32_t index, double push, const Vec3& slide) {
    contacts[index].move(inverse_inertia, push * contacts[index].normal + slide, velocity);
  });
}

void projectContacts(const Field& inverse_inertia, Contacts& contacts, Field3& position) noexcept {
  for (Contact& contact : contacts) {
    if (contact.mobility <= 0.0) continue;
    const double entered = contact.offset - contact.normal.dot(contact.point(position));
    const double change = contact.boundedChange(entered / contact.mobility);
    contact.push += change;
    contact.sticks = false;
    contact.move(inverse_inertia, change * contact.normal, position);
  }
  projectFriction(inverse_inertia, contacts, position);
}

}  // namespace curtain
