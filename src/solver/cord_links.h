// SPDX-License-Identifier: BSD-3-Clause
//
// Cords in the solve: one-sided constraints |x_end - x_node| <= length like the weft's strings, between any node and an
// end. They are few, so each is looked at by itself; those that take part are rows of the same solve (Row).
//
// Loads and fixed ends move here, since no rod or string ends at them. Lengths of closing loops shrink by their speed
// in every substep that holds; in the last resort they wait.
#pragma once

#include <algorithm>
#include <vector>

#include "cloth/cloth.h"
#include "solver/row.h"
#include "solver/warp_solver.h"

namespace curtain {

class Archive;

/// With the conventions of LinkSet, from the node (a) to the end (b).
struct CordLink {
  std::size_t node = 0, end = 0;  ///< in the fields
  double length = 1.0;            ///< at the end of the substep [m]
  double rate = 0.0;              ///< at which it changes [m/s]
  double unit = 1.0;  ///< what overlengths are measured by [m]: its length, but not more than that of a weft link, so
                      ///< that heavy loads on long lines don't shake the cloth by what a long line's tolerance is
  bool ties = false;  ///< it has a bound, and an end that can move
  Vec3 direction = Vec3::Zero();  ///< [m]
  double multiplier = 0.0;        ///< [kg]
  double last = 0.0;              ///< of the last accepted substep [kg]
  double violation = 0.0;         ///< C = (|r|^2 - length^2) / 2 less the compliance [m^2], or its rate
  bool active = false;            ///< it is too long, or pulls
};

/// Not thread-safe. Allocates only in the constructor.
class CordLinks {
 public:
  /// most_give: bound of the relative overlength by compliance; links: a typical link's length [m]. pattern must
  /// outlive this.
  CordLinks(const ClothPattern& pattern, double most_give, double links);

  void takeMostGive(double most_give) noexcept { most_give_ = most_give; }
  bool any() const noexcept { return !all_.empty(); }
  const std::vector<CordLink>& all() const noexcept { return all_; }
  const CordsPattern& pattern() const noexcept { return pattern_.cords; }

  // ---- Tie-backs

  /// Closes a loop from where its nodes are, or opens it. Between substeps.
  void close(std::size_t loop, bool closed, ClothState& state) noexcept;
  bool closed(std::size_t loop) const noexcept { return closed_[loop] != 0; }
  /// As the scene has them at the start.
  void resetLoops(ClothState& state) noexcept;
  /// A closed loop has not yet shrunk to its radius.
  bool closing(const ClothState& state) const noexcept;

  // ---- A substep of h [s] from `state`

  /// shrinks: closing loops do.
  void begin(const ClothState& state, const Field& inverse, double h, bool shrinks) noexcept;
  /// Predicts the ends: x + step (keep v + kick w F).
  void predict(const SubstepStart& start, const Field& inverse, Field3& next) const noexcept;
  /// Starts with the last substep's multipliers times ratio; true: one is not zero.
  bool warmStart(double ratio) noexcept;
  void setDirections(const Field3& position) noexcept;
  /// Moves nodes and ends by the present multipliers.
  void pull(const Field& inverse, Field3& value) const noexcept;
  /// Sets violation and active of each; returns the largest violation over a unit of those that take part, infinite
  /// when a position is not finite.
  double measure(const Field& inverse, const Field3& position) noexcept;
  double residual(const Field& inverse, const Field3& position) const noexcept;
  /// Sum of the squares of what measure() has found.
  double squares() const noexcept;
  /// Adds a row for each that ties, of what measure() or measureRates() has found.
  void addRows(Rows& rows) const;
  /// Moves nodes and ends by what was found for these rows.
  void moveByRows(RowRange rows, const Field& inverse, Field3& value) const noexcept;
  /// Adds a share of what was found to the multipliers, which stay >= 0.
  void takeUp(RowRange rows, double share) noexcept;
  /// Speed of the fastest loop that shrinks in this substep [m/s]; 0: none.
  double closingSpeed() const noexcept { return closing_speed_; }
  void saveIterate() noexcept;
  void restoreIterate() noexcept;

  /// Accepts: sets the ends' velocities, reaches, and adds to the loads of nodes. Returns the largest load over its
  /// mass.
  double commit(const SubstepStart& start, const Field3& next, ClothState& state, Field& load) noexcept;
  /// Not accepted: the present lengths are again those of `state`.
  void takeLengths(const ClothState& state) noexcept;

  // ---- The last accepted substep

  /// A cord pulled.
  bool pulls() const noexcept { return pulls_; }
  double last(std::size_t cord) const noexcept { return all_[cord].last; }
  /// Sum of multiplier times direction over the cords of a node, or of an end [kg m].
  Vec3 pullAt(std::size_t node) const noexcept;
  /// The same of the multipliers being solved for.
  Vec3 presentPullAt(std::size_t node) const noexcept;
  /// Adds the pulls of the last substep times share to nodal values along the present directions.
  void spread(double share, const Field& inverse, Field3& value) const noexcept;
  /// Largest relative overlength of any that ties.
  double stretch(const Field3& position) const noexcept;

  // ---- Velocities

  /// Those that pulled take part, with dC/dt = d . (v_end - v_node) - length * rate [m^2/s]. Returns the largest over
  /// length times unit.
  double measureRates(const Field3& velocity) noexcept;

  struct Memory {
    std::vector<double> last;

    void carry(Archive& archive);
  };
  void save(Memory& memory) const;
  void restore(const Memory& memory) noexcept;
  void forget() noexcept;
  /// closed loops and Memory.
  void carry(Archive& archive);
  void resume(const ClothState& state) noexcept;

 private:
  double violationOf(const CordLink& link, const Field& inverse, const Field3& position, bool& active) const noexcept;
  void move(const CordLink& link, double multiplier, const Field& inverse, Field3& value) const noexcept;
  void takeTies(const Field& inverse) noexcept;
  void setLength(CordLink& link, double length) noexcept;
  Vec3 sumAt(std::size_t node, double CordLink::*multiplier) const noexcept;

  const ClothPattern& pattern_;
  double most_give_;
  const double links_;
  std::vector<CordLink> all_;
  std::vector<std::uint8_t> closed_;  // by loop
  std::vector<double> reach_;         // of the loops at the end of the substep [m]
  std::vector<double> best_;          // multipliers of the iterate to return to
  double closing_speed_ = 0.0;
  bool pulls_ = false;
};

}  // namespace curtain
