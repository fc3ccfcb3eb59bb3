// SPDX-License-Identifier: BSD-3-Clause
//
// The weft, row by row: one-sided constraints |x_ij - x_i(j-1)| <= l. A link that is too long, or has a multiplier,
// takes part in the solve (NetSolver); slack links cost a comparison each. In closed cloth the link of column 0 joins
// the last column to the first.
#pragma once

#include "step/links.h"

namespace curtain {

/// Relative overlength of a weft link for each pull of a node's weight (mean mass times gravity), as of links of the
/// mean length: the same in any substep, so that links that give hold no energy that comes and goes with its length. It
/// tends to LinkSet::max_give; without gravity there is none. Of cloth that touches something: a net has about as many
/// links as degrees of freedom in its plane, so some combinations of pulls hardly move anything. With contacts, whose
/// rows are damped, the solve does not determine them without compliance: lengths come and go by more than the aim from
/// sweep to sweep, and draped cloth trembles for ever.
constexpr double kWeftCompliance = 4e-4;
/// The same where nothing touches: without it a straight row between two pins (a singular system) would pull without
/// bounds, and what sags at all within the tolerance would be drawn up again in the next substep. With 1e-9 cloth hung
/// by two corners needs the last resort more often; with 5e-9 hysteresis gains the energy that links give.
constexpr double kStraightCompliance = 1e-9;

/// Sets the directions of a row's links from the positions.
void setWeftDirections(const Grid& grid, int row, const Field3& position, Field3& direction) noexcept;

/// 1 / rest length^2 of the links with a movable end, 0 of the others [1/m^2]. out has the grid's size.
void freeWeft(const ClothPattern& pattern, const Field& inverse_mass, Field& out) noexcept;

/// Largest (length / rest length)^2 of a row's links with a movable end; infinite when a position is not finite.
double weftSquare(const Grid& grid, int row, const Field3& position, const Field& free_per_square) noexcept;

/// What is known of each link of the weft.
struct WeftFields {
  Field& violation;   ///< C = (|r|^2 - l^2) / 2 less what it gives [m^2], negative where it is slack
  Field& active;      ///< 1: it takes part, 0: it does not
  Field& compliance;  ///< by how much more it gives for each unit of multiplier * (w_a + w_b); 0 where it gives all
                      ///< that it may
};

/// Sets these for a row. Returns the largest relative violation of the links that take part, infinite when a position
/// is not finite.
double measureWeft(const LineSolve& line, int row, const WeftFields& out) noexcept;

/// The same for velocities: links that pull take part, with dC/dt = d . (v_b - v_a) [m^2/s]; returns the largest over
/// l^2.
double measureWeftRates(const LineSolve& line, int row, Field& violation, Field& active) noexcept;

/// Bounds a row's changes so that multipliers stay >= 0, and adds them.
void applyWeftChange(LinkSet& links, const Grid& grid, int row, Field& change) noexcept;

/// Moves a row's nodes by multipliers (all, or a change) along the links' directions.
void pullWeft(const LineSolve& line, int row, const Field& multiplier) noexcept;

/// Largest displacement that pullWeft would cause in the row, over the rest length of a link, squared.
double weftMoveSquared(const LineSolve& line, int row, const Field& multiplier) noexcept;

/// Largest relative overlength of any weft link with a free end.
double weftStretch(const ClothPattern& pattern, const Field3& position) noexcept;

}  // namespace curtain
