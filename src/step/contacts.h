// SPDX-License-Identifier: BSD-3-Clause
//
// Contacts as the solvers see them: one-sided constraints on up to four nodes, with Coulomb friction. They are rows of
// the same system as the links; src/contact finds them.
//
// A contact point is a fixed combination of nodes, p = sum weight_k x_k (against an obstacle: a point of the cloth; in
// self-contact: the difference of two points, so the weights add up to 0). The constraint is normal . p >= offset. Its
// normal multiplier `push` and tangential multiplier `slide` move the nodes by
//     x_k += w_k weight_k (push normal + slide),   push >= 0, |slide| <= friction push,
// so over a substep of length h whose forces act for a time `kick` the forces are (push, slide) / (h kick) [N].
//
// A node that two obstacles pinch, which press on it from both sides by a given force, is one contact: two-sided, since
// either obstacle pushes with press + or - half of `push`, and with a friction bound that does not depend on `push`.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"
#include "step/row.h"

namespace curtain {

struct Contact {
  static constexpr int kCloth = -1;
  static constexpr std::uint32_t kNowhere = ~std::uint32_t{0};

  std::array<std::uint32_t, 4> node{};  ///< in the grid's fields
  std::array<double, 4> weight{};
  int nodes = 1;                ///< how many of the four are used
  int obstacle = kCloth;        ///< index, or kCloth
  int other = kCloth;           ///< pinched: the obstacle on the other side, which the normal points to
  Vec3 normal = Vec3::UnitZ();  ///< unit, towards the allowed side
  double offset = 0.0;          ///< [m]
  double recovery = 0.0;        ///< part of the offset that takes out penetration [m]; the last resort may skip it
  Vec3 carried = Vec3::Zero();  ///< point at the end of the substep without slip [m]; only its tangential part is read
  Vec3 surface_velocity = Vec3::Zero();  ///< of what the point touches [m/s]
  double friction = 0.0;                 ///< Coulomb coefficient, >= 0; pinched: the sum of both sides'
  double press = 0.0;                    ///< pinched: what either side presses with [N]; 0: not pinched
  double hold = 0.0;                     ///< friction * press as a multiplier [kg m]
  double push = 0.0;                     ///< normal multiplier [kg m], >= 0 unless pinched
  Vec3 slide = Vec3::Zero();             ///< tangential multiplier [kg m]
  double mobility = 0.0;                 ///< sum of weight^2 w, inverse effective mass of the point [1/kg]
  bool sticks = false;                   ///< solved for as sticking, until the friction bound is reached
  std::uint32_t source = 0;              ///< for the finder

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
  bool pushes() const noexcept { return push > 0.0 || press > 0.0; }
  /// Bound of slide [kg m].
  double mostSlide() const noexcept { return press > 0.0 ? hold : friction * push; }
  /// A change of push within its bound.
  double boundedChange(double change) const noexcept { return press > 0.0 ? change : std::max(change, -push); }
};

using Contacts = std::vector<Contact>;

/// Starts a solve with the contacts from `first` on: sets their mobility and warm-starts them with their multipliers
/// times `ratio`, which moves the nodes. scale: h * kick [s^2].
void beginContacts(const Field& inverse_inertia, double scale, double ratio, std::size_t first, Contacts& contacts,
                   Field3& position) noexcept;

/// Penetration [m], or (negative) separation of a contact that pushes; 0: the constraint is satisfied.
inline double contactViolation(const Contact& contact, const Field3& position) noexcept {
  const double entered = contact.offset - contact.normal.dot(contact.point(position));
  return entered > 0.0 || contact.pushes() ? entered : 0.0;
}

/// Largest of these, and of the slip of sticking contacts [m]; infinite when a position is not finite. recovers: count
/// penetration that `recovery` should take out; false: only deeper penetration.
double contactResidual(const Contacts& contacts, const Field3& position, bool recovers = true) noexcept;

/// Largest normal speed of a pushing contact, or (sticking) slip speed [m/s].
double contactRate(const Contacts& contacts, const Field3& velocity) noexcept;

/// Largest speed of an obstacle's point that is pushed on [m/s].
double fastestSurface(const Contacts& contacts) noexcept;

/// Largest speed that contacts drive points with [m/s]: that of the surface, or of depenetration from `start` [m] in a
/// step of h [s].
double fastestDrive(const Contacts& contacts, const Field3& start, double h) noexcept;

bool anyPushes(const Contacts& contacts) noexcept;

/// A contact with an obstacle pushes.
bool pressesOnObstacle(const Contacts& contacts) noexcept;

/// Friction of the contacts that are not solved for as sticking, one after the other. Moves nodes.
void projectFriction(const Field& inverse_inertia, Contacts& contacts, Field3& position) noexcept;

/// Adds a row along the normal of every contact that pushes or penetrates, and two tangential ones where it sticks.
void addContactRows(const Contacts& contacts, const Field3& position, Rows& rows);
/// The same of velocities, for the contacts that push.
void addContactRateRows(const Contacts& contacts, const Field3& velocity, Rows& rows);

/// Adds a share of what was found for the contacts' rows to their multipliers, bounded to push >= 0 and Coulomb's disc.
/// Moves nodes.
void takeUpContacts(const Field& inverse_inertia, RowRange rows, double share, Contacts& contacts,
                    Field3& position) noexcept;
/// Moves velocities by what was found for the contacts' rate rows.
void moveByContacts(const Field& inverse_inertia, RowRange rows, const Contacts& contacts, Field3& velocity) noexcept;

/// Solves each contact by itself, one after the other, for schemes without a joint solve. Moves nodes.
void projectContacts(const Field& inverse_inertia, Contacts& contacts, Field3& position) noexcept;

}  // namespace curtain
