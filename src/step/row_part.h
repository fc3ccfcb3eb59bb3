// SPDX-License-Identifier: BSD-3-Clause
//
// A part that bounds distances between nodes, and what the solver asks of it. The solver keeps the rows: their
// directions, their multipliers, who of them takes part. The part says between which nodes they are, how long they may
// be or how far they give, and moves the nodes that are its own. It may drive: shorten its rows as time goes on.
#pragma once

#include "cloth/cloth.h"
#include "step/warp_solver.h"

namespace curtain {

class Archive;

/// One-sided: |x_other - x_node| <= length + compliance * pull. With the conventions of LinkSet, from the node (a) to
/// the other (b).
struct DistanceRow {
  // Set once, by its part.
  std::size_t node = 0, other = 0;  ///< in the fields
  double compliance = 0.0;          ///< [m/N], >= 0; 0: it does not give, and is a constraint
  // Set by its part before every substep.
  double length = 1.0;  ///< at the end of the substep [m]
  double rate = 0.0;    ///< at which the part that drives changes it [m/s]
  bool holds = false;   ///< it has a bound, and an end that can move
  // The solver's.
  Vec3 direction = Vec3::Zero();  ///< [m]
  double multiplier = 0.0;        ///< [kg]
  double last = 0.0;              ///< of the last accepted substep [kg]
  double violation = 0.0;         ///< C = (|r|^2 - length^2) / 2 less the compliance [m^2], or its rate
  bool active = false;            ///< it is too long, or pulls
};

/// Not thread-safe. Allocates only in its constructor.
class RowPart {
 public:
  virtual ~RowPart() = default;

  /// How many rows it has; always the same.
  virtual std::size_t count() const noexcept = 0;
  /// Gets its rows, and sets their nodes and lengths. They stay where they are.
  virtual void attach(DistanceRow* rows) noexcept = 0;

  /// Before a substep from `start` at `state`: sets its rows. inverse: of the nodes in this substep [1/kg]; drives:
  /// it does. Predicts the nodes that are its own into `next`.
  virtual void begin(const SubstepStart& start, const ClothState& state, const Field& inverse, bool drives,
                     Field3& next) noexcept = 0;
  /// The substep is accepted: sets what of the state is its own.
  virtual void commit(const SubstepStart& /*start*/, const Field3& /*next*/, ClothState& /*state*/) noexcept {}
  /// Between substeps, after one that was not accepted or when `state` comes from elsewhere: sets its rows.
  virtual void resume(const ClothState& /*state*/) noexcept {}
  /// Work of what drives in the last substep, which took the velocities from `before` to `after` [J]; per_h: force over
  /// multiplier, times the time that it acted for [1/s]. Rows of constant length do none.
  virtual double work(const Field3& /*before*/, const Field3& /*after*/, double /*per_h*/) const noexcept {
    return 0.0;
  }
};

}  // namespace curtain
