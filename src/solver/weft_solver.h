// SPDX-License-Identifier: BSD-3-Clause
//
// The weft: one-sided constraints |x_ij - x_i(j-1)| <= l. A link that is taut, or still pulls, takes part in the
// tridiagonal solve of its row; a row of slack links costs a comparison each. Rows of closed cloth are cyclic systems.
#pragma once

#include <vector>

#include "solver/links.h"
#include "solver/tridiagonal.h"

namespace curtain {

/// Compliance of the weft: a link under load s = multiplier * (w_a + w_b) may be longer by this times s, relative.
/// It vanishes with the square of the substep, and keeps a straight row between two pins (a singular system) solvable.
constexpr double kWeftCompliance = 1e-7;

class WeftSolver {
 public:
  explicit WeftSolver(const Grid& grid);

  /// Directions of the links at the given positions.
  static void setDirections(const Grid& grid, const Field3& position, Field3& direction) noexcept;

  /// Moves the positions by the multipliers there are (warm start).
  static void applyMultipliers(const LineSolve& line) noexcept;

  /// Solves every row whose links are not within tolerance, with a bounded number of Newton iterations: moves
  /// positions, adds to the multipliers, never below zero. With follow_directions the links' directions are those of
  /// the present positions (implicit scheme). further: share of each row's change that is added on top
  /// (over-relaxation of the alternation with the warp), [0..1). residual: the largest before the solve.
  /// leave_alone: residual up to which a row is not touched at all, <= tolerance.
  LineOutcome solve(const LineSolve& line, double tolerance, double leave_alone, bool follow_directions,
                    double further = 0.0) noexcept;

  /// Largest relative violation of any link, as solve() judges it. Changes nothing.
  double residual(const LineSolve& line) noexcept;

  /// Makes velocities keep the lengths of the links that pull (multiplier > 0), to first order: one pass over the
  /// rows. The multipliers stay as they are.
  LineOutcome projectVelocity(const LineSolve& line) noexcept;

 private:
  // Two nodes; the link is stored at the right one.
  struct Link {
    std::size_t left;
    std::size_t right;
  };
  void listLinks(const Grid& grid, int row) noexcept;
  double measurePositions(const LineSolve& line, int row) noexcept;
  double measureVelocities(const LineSolve& line, int row) noexcept;
  void buildMatrix(const LineSolve& line, bool velocity_level) noexcept;
  void movePositions(const LineSolve& line) noexcept;
  void relaxFurther(const LineSolve& line, double share) noexcept;
  void moveVelocities(const LineSolve& line) noexcept;

  std::vector<Link> links_;  // of the row at hand
  Field active_;             // 1 or 0, by the column of the link's right node
  Field violation_;          // of the links that take part [m^2], 0 of the others; velocities: its rate [m^2/s]
  Field before_;             // multipliers before the row was solved
  TridiagonalSystem system_;
};

/// Largest relative overlength of any weft link with a free end.
double weftStretch(const ClothPattern& pattern, const Field3& position) noexcept;

}  // namespace curtain
