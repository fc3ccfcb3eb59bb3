// SPDX-License-Identifier: BSD-3-Clause
//
// The weft, row by row: one-sided constraints |x_ij - x_i(j-1)| <= l. A link that is too long, or still pulls, takes
// part in the solve (NetSolver); a row of slack links costs a comparison each. In closed cloth the link of column 0
// joins the last column to the first.
#pragma once

#include "solver/links.h"

namespace curtain {

/// Compliance of the weft: a link under load s = multiplier * (w_a + w_b) may be longer by this times s, relative.
/// It vanishes with the square of the substep, and keeps a straight row between two pins (a singular system) solvable.
/// Not longer than LinkSet::most_give, whatever the load.
constexpr double kWeftCompliance = 1e-7;

/// Directions of a row's links at the given positions.
void setWeftDirections(const Grid& grid, int row, const ColumnSpan& span, const Field3& position,
                       Field3& direction) noexcept;

/// Largest relative violation of the links of a row that take part; infinite when a position is not finite.
double weftResidual(const LineSolve& line, int row) noexcept;

/// 1 / rest length^2 of the links with an end that can move, 0 of the others [1/m^2]. out has the grid's size.
void freeWeft(const ClothPattern& pattern, const Field& inverse_mass, Field& out) noexcept;

/// Largest square of a link's length over that of its rest length, of a row's links with an end that can move; infinite
/// when a position is not finite.
double weftSquare(const Grid& grid, int row, const ColumnSpan& span, const Field3& position,
                  const Field& free_per_square) noexcept;

/// The residual, and for every link of the row: whether it takes part (1 or 0) and its violation C = (|r|^2 - l^2) / 2
/// less what its compliance allows [m^2], negative where it is slack.
double measureWeft(const LineSolve& line, int row, Field& violation, Field& active) noexcept;

/// For velocities: the links that pull take part, with dC/dt = d . (v_b - v_a) [m^2/s]; returns the largest over l^2.
double measureWeftRates(const LineSolve& line, int row, Field& violation, Field& active) noexcept;

/// Cuts a row's changes of multipliers to what keeps strings from pushing, and adds them to the multipliers.
void takeUpWeft(LinkSet& links, const Grid& grid, int row, Field& change) noexcept;

/// Moves a row's nodes by multipliers (all of them: warm start; or a change) along the links' directions.
void pullWeft(const LineSolve& line, int row, const Field& multiplier) noexcept;

/// How far pullWeft would move the row's node that goes farthest, over the rest length of a link, squared.
double weftMoveSquared(const LineSolve& line, int row, const Field& multiplier) noexcept;

/// Largest relative overlength of any weft link with a free end.
double weftStretch(const ClothPattern& pattern, const Field3& position) noexcept;

}  // namespace curtain
