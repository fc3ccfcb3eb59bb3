// SPDX-License-Identifier: BSD-3-Clause
//
// Contacts as the solvers see them: one-sided constraints on up to four nodes, with Coulomb friction. src/contact finds
// them.
//
// A contact point is a fixed combination of nodes, p = sum weight_k x_k (against an obstacle: a point of the cloth; in
// self-contact: the difference of two points, so the weights add up to 0). The constraint is level . p >= offset. Its
// normal multiplier `push`, along `normal`, and tangential multiplier `slide` move the nodes by
//     x_k += w_k weight_k (push normal + slide),   push >= 0, |slide| <= friction push,
// so over a substep of length h whose forces act for a time `kick` the forces are (push, slide) / (h kick) [N].
//
// Friction is part of the same solve. A contact that sticks has three rows. One that may slip has a single row, along
// normal + lean: while its push changes, its force keeps its direction, on Coulomb's cone. So the ends of a strap that
// slips over a bar are at e^(friction angle) at once, where the slides of one contact after the other would take many
// sweeps. Which way a contact slips that has just begun is not known yet: it does not lean, or a bar that hits cloth at
// 50 revolutions a second gives it more than the bar's work.
//
// A node that two obstacles pinch, which press on it from both sides by a given force, is one contact: two-sided, since
// either obstacle pushes with press + or - half of `push`, and with a friction bound that does not depend on `push`.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"
#include "scene/infinity.h"
#include "step/constants.h"
#include "step/row.h"

namespace curtain {

class ContactFinder;

struct Contact {
  static constexpr int kCloth = -1;
  static constexpr double kMinRise = 0.5;  // of a point that turns further in a substep: the next sweeps see it
  static constexpr std::uint32_t kNowhere = ~std::uint32_t{0};

  std::array<std::uint32_t, 4> node{};  ///< in the grid's fields
  std::array<double, 4> weight{};
  int nodes = 1;                ///< how many of the four are used
  int obstacle = kCloth;        ///< index, or kCloth
  int other = kCloth;           ///< pinched: the obstacle on the other side, which the normal points to
  Vec3 normal = Vec3::UnitZ();  ///< unit, along which it pushes, towards the allowed side
  Vec3 level = Vec3::UnitZ();   ///< unit, normal of the plane that the point stays above
  double offset = 0.0;          ///< of that plane: level . p >= offset [m]
  bool curved = false;          ///< the plane is tangent to what is touched, and goes along with the point
  double asked = 0.0;           ///< curved: distance that is asked for at the end [m]
  double recovery = 0.0;        ///< way out of what it is too deep in [m], >= 0; the last resort may skip it
  /// What it may lack [m]: with more, a point that is near the surface already goes more than half of the way to it.
  double room = kInfinity;
  Vec3 anchor = Vec3::Zero();  ///< point at the end of the substep without slip [m]; only its tangential part is read
  Vec3 anchor_normal = Vec3::UnitZ();    ///< of what it touched at the start, as that has turned by the end
  Vec3 surface_velocity = Vec3::Zero();  ///< of what the point touches, when the force acts [m/s]
  Vec3 end_velocity = Vec3::Zero();      ///< the same at the substep's end [m/s]
  double friction = 0.0;                 ///< Coulomb coefficient, >= 0; pinched: the sum of both sides'
  double press = 0.0;                    ///< pinched: what either side presses with [N]; 0: not pinched
  double hold = 0.0;                     ///< friction * press as a multiplier [kg m]
  double push = 0.0;                     ///< normal multiplier [kg m], >= 0 unless pinched
  Vec3 slide = Vec3::Zero();             ///< tangential multiplier [kg m]
  Vec3 settled = Vec3::Zero();           ///< impulse that projected velocities took up beside the multipliers [N s]
  double mobility = 0.0;                 ///< sum of weight^2 w, inverse effective mass of the point [1/kg]
  bool sticks = false;                   ///< it has rows across the normal, until the bound is reached
  Vec3 lean = Vec3::Zero();              ///< of its force where it may slip: slide over push
  bool leans = false;                    ///< it may: it pushed in the last substep, too
  std::uint32_t source = 0;              ///< for the finder
  bool ran_into = false;                 ///< of a face that the node ran into in this substep; found within the solve

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
  /// How far below the plane [m]; negative: above it.
  double depth(const Field3& position) const noexcept { return offset - level.dot(point(position)); }
  /// All of its nodes are above its plane, and what is between them.
  bool isAbove(const Field3& position) const noexcept {
    bool above = true;
    for (int k = 0; k < nodes; ++k)
      above = above && level.dot(position.at(node[static_cast<std::size_t>(k)])) >= offset;
    return above;
  }
  /// The point is this far from what it touches, whose normal is there `to`: that of a far side is not taken.
  void turnTo(const Vec3& to, double distance, const Field3& position) noexcept {
    if (!(to.dot(normal) > 0.0)) return;
    level = to;
    offset = level.dot(point(position)) + asked - distance;
  }
  /// Whether a normal is that of the face that it has met, which may bend a little.
  bool isOf(const Vec3& to) const noexcept { return (to - level).squaredNorm() <= kMaxTurn * kMaxTurn; }
  /// Whether what is nearest at a place, where its normal is `to`, is another face that the point has run into: it is
  /// turned against the point's motion, as in a valley of a mesh. (Around a convex shape it turns with the motion.)
  /// Such a face has a contact of its own: one that jumped from face to face would not converge in a substep of any
  /// length, and a push along the first one's normal gives a node that runs into a slope of 37 degrees 1.6 times its
  /// kinetic energy.
  bool runsInto(const Vec3& to, const Vec3& at) const noexcept { return !isOf(to) && turnsAgainst(to, at); }
  bool turnsAgainst(const Vec3& to, const Vec3& at) const noexcept {
    return (to - anchor_normal).dot(at - anchor) < 0.0;
  }
  /// Share of a motion along the normal that goes across the plane.
  double rise() const noexcept { return std::max(kMinRise, level.dot(normal)); }
  Vec3 across(const Vec3& v) const { return v - normal.dot(v) * normal; }
  /// Bound of slide [kg m].
  double maxSlide() const noexcept { return press > 0.0 ? hold : friction * push; }
  /// The slide that would end the slip, if nothing else moved.
  Vec3 wantedSlide(const Field3& position) const { return slide - across(point(position) - anchor) / mobility; }
  /// It may slip from now on.
  void slip() noexcept {
    sticks = false;
    lean = !leans || press > 0.0 || push == 0.0 ? Vec3(Vec3::Zero()) : Vec3(slide / push);
  }
  /// Projection on Coulomb's disc.
  Vec3 boundedSlide(const Vec3& wanted) const {
    const double size = wanted.norm(), most = maxSlide();
    return size > most ? Vec3(wanted * (most / size)) : wanted;
  }
  /// A change of push within its bound.
  double boundedChange(double change) const noexcept { return press > 0.0 ? change : std::max(change, -push); }
};

using Contacts = std::vector<Contact>;

/// Starts a solve with the contacts from `first` on: sets their mobility and warm-starts them with their multipliers
/// times `ratio`, which moves the nodes. scale: h * kick [s^2].
void beginContacts(const Field& inverse_inertia, double scale, double ratio, std::size_t first, Contacts& contacts,
                   Field3& position) noexcept;

/// Largest speed of an obstacle's point that is pushed on [m/s].
double fastestSurface(const Contacts& contacts) noexcept;

/// The longest step that resolves what is touched [s]: how far its surface moves, compared with the shortest link [m]
/// and, where it arrives, with the distance that is kept from it; and the angle by which normals turn. h: of this
/// substep [s].
double longestStep(const Contacts& contacts, double h, double link) noexcept;

/// Largest speed that contacts drive points with [m/s]: that of the surface, or of depenetration in a step of h [s].
double fastestDrive(const Contacts& contacts, double h) noexcept;

bool anyPushes(const Contacts& contacts) noexcept;

/// A contact of the cloth with itself pushes.
bool pressesOnItself(const Contacts& contacts) noexcept;

/// A contact with an obstacle pushes.
bool pressesOnObstacle(const Contacts& contacts) noexcept;

/// Solves each contact by itself, one after the other, for schemes without a joint solve. Moves nodes.
void projectContacts(const Field& inverse_inertia, Contacts& contacts, Field3& position) noexcept;

/// Contacts in the solve: a row along the force of each that pushes or penetrates, and two more where it sticks.
class ContactRows final : public RowMaker {
 public:
  /// links: a typical link's length [m].
  explicit ContactRows(double links) : links_(links) {}
  /// Reserves room for so many contacts.
  void expect(std::size_t count) { best_.reserve(count); }

  /// Those of the substep being made; null: nothing can touch.
  void set(Contacts* contacts, ContactFinder* finder) noexcept {
    all_ = solved_ = contacts != nullptr ? contacts : &none_;
    finder_ = finder;
  }
  /// Looks at the contacts where their points are now.
  void relinearise(const Field3& position) noexcept;
  /// Those of the last substep, for velocities; null: none pushed.
  void show(const Contacts* contacts) noexcept { all_ = contacts != nullptr ? contacts : &none_; }
  const Contacts& all() const noexcept { return *all_; }

  /// Largest penetration, separation of a contact that pushes, or slip of one that sticks [m]; infinite when a position
  /// is not finite. recovers: count penetration that Contact::recovery should take out; false: only deeper penetration.
  /// What has less room than the tolerance [m] counts for as much as that is less.
  double residual(const Field3& position, bool recovers, double tolerance) const noexcept;
  /// Turns the slides of those that may slip, and of cloth on cloth, against their slips. Moves nodes.
  void slide(const Field& inverse, Field3& position) noexcept;

  void addRows(const Field3& value, bool rates, Rows& rows) const override;
  void applyChange(const Rows& rows, double share, const Field& inverse, Field3& position) noexcept override;
  void addSquares(const Field3& position, double& sum) const noexcept override;
  void saveIterate() override { best_ = *solved_; }
  void restoreIterate() noexcept override { *solved_ = best_; }
  double measureRates(const Field3& velocity) noexcept override;
  void moveBy(const Rows& rows, const Field& inverse, Field3& velocity) noexcept override;
  void spread(double share, const Field& inverse, Field3& velocity) const noexcept override;

 private:
  const double links_;
  Contacts none_, best_;
  ContactFinder* finder_ = nullptr;
  const Contacts* all_ = &none_;
  Contacts* solved_ = &none_;
};

}  // namespace curtain
