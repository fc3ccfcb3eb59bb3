// SPDX-License-Identifier: BSD-3-Clause
//
// The warp: two-sided constraints |x_ij - x_(i-1)j| = l. A column's rods couple neighbours only, so a Newton iteration
// is one tridiagonal solve per column; all columns are swept side by side, row by row.
#pragma once

#include "solver/links.h"

namespace curtain {

/// Directions of the rods at the given positions.
void setWarpDirections(const Grid& grid, const Field3& position, Field3& direction) noexcept;

/// Moves the positions by the multipliers there are (warm start).
void applyWarpMultipliers(const LineSolve& line) noexcept;

/// One Newton iteration on the rods' lengths: moves positions and adds to the multipliers.
LineOutcome warpNewton(const LineSolve& line, LineScratch& scratch) noexcept;

/// Makes velocities keep the rods' lengths to first order (one linear solve; the links' multipliers are spent on it).
LineOutcome warpProjectVelocity(const LineSolve& line, LineScratch& scratch) noexcept;

/// Largest relative over- and underlength of any rod with a free end.
struct Stretch {
  double longer = 0.0;
  double shorter = 0.0;
};
Stretch warpStretch(const ClothPattern& pattern, const Field3& position) noexcept;

}  // namespace curtain
