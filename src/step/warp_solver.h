// SPDX-License-Identifier: BSD-3-Clause
//
// The warp: two-sided constraints |x_ij - x_(i-1)j| = l. A column's rods couple neighbours only, so a Newton iteration
// is one tridiagonal solve per column. The columns of a block (a cache line wide) are solved side by side, row by row;
// blocks are independent.
#pragma once

#include "step/links.h"

namespace curtain {

/// Blocks of kLane columns that a row holds, padding included.
inline int warpBlockCount(const Grid& grid) { return (grid.columns + kLane - 1) / kLane; }

/// Sets the directions of the rods from the positions: of all, or of one block of columns.
void setWarpDirections(const Grid& grid, const Field3& position, Field3& direction) noexcept;
void setWarpDirections(const Grid& grid, int block, const Field3& position, Field3& direction) noexcept;

/// Where a substep starts from.
struct SubstepStart {
  const ClothState& state;
  const Field3& force;  ///< [N]
  const Vec3* uniform;  ///< acceleration of all free nodes [m/s^2], in place of force and inertia; or null
  const Field* keep;    ///< share of its velocity that damping leaves a node; null: all of it
  double kick;          ///< time that the forces act for [s]
  double h;             ///< [s]
};

/// For a block of columns: predicts x + h (keep v + kick w F) into line.value, sets the rods' directions from the
/// start, and warm-starts with the multipliers `last` times `ratio`.
void warpBegin(const SubstepStart& start, const LineSolve& line, const Field& last, double ratio, int block) noexcept;

/// Motion of a block in a substep.
struct WarpMotion {
  double heaviest = 0.0;  ///< the largest load of a node over its mass [1]
  double turning = 0.0;   ///< sum over the rods of |change of (v_b - v_a)|^2 / l^2 [1/s^2]
};

/// Sets the velocities of a block's nodes, from `from` to line.value, and their loads: sum of |multiplier| of their
/// rods [kg]. tells_turning: compute WarpMotion::turning.
WarpMotion warpFinish(const LineSolve& line, const Field3& from, double per_step, bool tells_turning, Field3& velocity,
                      Field& load, int block) noexcept;

/// Moves a block's nodes by what rods with these multipliers pull.
void pullWarp(const LineSolve& line, int block, const Field& multiplier) noexcept;

/// One Newton iteration on the lengths of a block's rods: moves positions and adds to the multipliers.
LineOutcome warpNewton(const LineSolve& line, LineScratch& scratch, int block) noexcept;

/// The residual that warpNewton would start with.
double warpResidual(const LineSolve& line, int block) noexcept;

/// Projects velocities so that a block's rods keep their lengths (one linear solve; overwrites the multipliers).
LineOutcome warpProjectVelocity(const LineSolve& line, LineScratch& scratch, int block) noexcept;

/// Largest relative over- and underlength of any rod with a free end.
struct Stretch {
  double longer = 0.0;
  double shorter = 0.0;
};
Stretch warpStretch(const ClothPattern& pattern, const Field3& position) noexcept;

}  // namespace curtain
