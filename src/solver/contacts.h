// SPDX-License-Identifier: BSD-3-Clause
//
// Contacts as the solvers see them: one-sided constraints on up to four nodes, with Coulomb friction. Who finds them
// knows where they come from (src/contact); here they are rows of the same system as the links.
//
// A contact point is a fixed mixture of nodes, p = sum weight_k x_k (against an obstacle: a point of the cloth; against
// the cloth itself: a point less the one it touches, so the weights add up to 0). It must keep  normal . p >= offset.
// Its multipliers, push along the normal and slide across it, move the nodes by
//     x_k += w_k weight_k (push normal + slide),   push >= 0, |slide| <= friction push,
// so over a substep of length h whose forces act for a time `kick` the forces are (push, slide) / (h kick) [N].
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"

namespace curtain {

struct Contact {
  static constexpr int kCloth = -1;

  std::array<std::uint32_t, 4> node{};  ///< in the grid's fields
  std::array<double, 4> weight{};
  int nodes = 1;                ///< of the four that take part
  int obstacle = kCloth;        ///< index, or kCloth
  Vec3 normal = Vec3::UnitZ();  ///< unit, the way the point is held to
  double offset = 0.0;          ///< [m]
  double recovery =
      0.0;  ///< of the offset, asked to bring out what is inside [m]; the last resort may fall short of it
  Vec3 carried = Vec3::Zero();  ///< where the point is at the end when it does not slip [m]; read across the normal
  Vec3 surface_velocity = Vec3::Zero();  ///< of what the point touches [m/s]
  double friction = 0.0;                 ///< Coulomb's coefficient, >= 0
  double push = 0.0;                     ///< [kg m]
  Vec3 slide = Vec3::Zero();             ///< [kg m]
  double mobility = 0.0;                 ///< sum of weight^2 w: how the point answers its multipliers by itself [1/kg]
  bool pressed = false;                  ///< it pushed when the substep began
  bool sticks = false;                   ///< solved for as held across the normal too, until its bound is reached
  std::uint32_t source = 0;              ///< the finder's own

  Vec3 point(const Field3& value) const noexcept {
    Vec3 p = weight[0] * value.at(node[0]);
    for (int k = 1; k < nodes; ++k) {
      const auto at = static_cast<std::size_t>(k);
      p += weight[at] * value.at(node[at]);
    }
    return p;
  }
  void move(const Field& inverse_inertia, const Vec3& multiplier, Field3& value) const noexcept {
    for (int k = 0; k < nodes; ++k) {
      const auto at = static_cast<std::size_t>(k);
      value.add(node[at], (inverse_inertia[node[at]] * weight[at]) * multiplier);
    }
  }
  bool pushes() const noexcept { return push > 0.0; }
};

using Contacts = std::vector<Contact>;

/// Starts a solve with the contacts from `first` on: how nodes answer now, and the multipliers that the contacts come
/// with times `ratio` (warm start), by which the nodes move.
void beginContacts(const Field& inverse_inertia, double ratio, std::size_t first, Contacts& contacts,
                   Field3& position) noexcept;

/// How far a contact is from what it asks for: entered [m], or left while it pushes; 0 where nothing is asked.
inline double contactViolation(const Contact& contact, const Field3& position) noexcept {
  const double entered = contact.offset - contact.normal.dot(contact.point(position));
  return entered > 0.0 || contact.pushes() ? entered : 0.0;
}

/// The largest of them, and of how far points that stick have slipped [m]; infinite when a position is not finite.
/// recovers: what is inside must come out as fast as it is asked to; else it must not go deeper.
double contactResidual(const Contacts& contacts, const Field3& position, bool recovers = true) noexcept;

/// Fastest that a point which is pressed on enters, leaves, or (sticking) slips [m/s].
double contactRate(const Contacts& contacts, const Field3& velocity) noexcept;

/// Of the obstacles' points that are pushed on [m/s].
double fastestSurface(const Contacts& contacts) noexcept;

/// The fastest that contacts drive points [m/s]: with what they touch, or out of where they were at `start` [m] in a
/// step of h [s].
double fastestDrive(const Contacts& contacts, const Field3& start, double h) noexcept;

/// Whether any of them pushes.
bool anyPushes(const Contacts& contacts) noexcept;

/// Something other than the cloth is pushed on.
bool pressesOnObstacle(const Contacts& contacts) noexcept;

/// Friction of the contacts that are not solved for as held, one after the other. Moves nodes.
void rubContacts(const Field& inverse_inertia, Contacts& contacts, Field3& position) noexcept;

/// Changes of a contact's multipliers, cut to what it may do: moves the nodes.
void takeUpContact(const Field& inverse_inertia, double push, const Vec3& slide, Contact& contact,
                   Field3& position) noexcept;

/// One contact after the other by itself, as for cloth without a joint solve. Moves nodes.
void projectContacts(const Field& inverse_inertia, Contacts& contacts, Field3& position) noexcept;

}  // namespace curtain
