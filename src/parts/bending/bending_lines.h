// SPDX-License-Identifier: BSD-3-Clause
//
// Lines of nodes that resist bending, for all lines of a direction side by side.
//
// With a_i = 1 / l_i of the link from node i - 1 to node i, the turn at a node is the difference of its links'
// directions, measured in rest lengths,
//     (C x)_i = a_(i+1) (x_(i+1) - x_i) - a_i (x_i - x_(i-1)),
// its energy k_i / 2 |(C x)_i|^2, which is k (1 - cos(turn)) between links at their lengths (Bergou et al. 2008), its
// moment m = k C x, and the force on the nodes -C^T m. Since it is linear in the positions, the three coordinates have
// the same matrix K = C^T k C, which nothing but the rest lengths enters.
//
// A line whose nodes give way, by `give` D [m/N] each, has the moments
//     (1/k + C D C^T) m = C x
// and the force -A x with A = C^T (1/k + C D C^T)^-1 C = (K^-1 + D)^-1, joints and nodes in series. A is symmetric,
// A <= K and A <= D^-1: bounded however stiff the line is. It exerts neither a net force nor a net torque.
#pragma once

#include "cloth/cloth.h"

namespace curtain {

/// What is constant of a direction's lines, in the layout of Field. Links and joints that are missing have a = 0 and
/// k = 0.
struct BendingLines {
  Field per_rest;    ///< a of the link to the node before [1/m]
  Field stiffness;   ///< k [N m]
  Field compliance;  ///< 1/k [1/(N m)]; infinite: no joint
  /// K by links: the shear of link i is own_i d_i - joined_i d_(i-1) - joined_(i+1) d_(i+1), d = x_i - x_(i-1), own =
  /// a_i^2 (k_(i-1) + k_i), joined = a_i a_(i-1) k_(i-1) [N/m]. Differences first: their rounding is that of lengths.
  /// The link that closes a ring is left out.
  Field own, joined;
  /// a of weft links whose press is spared, see addShears(); 0 of lines that turn at rest, whose couples press as well.
  Field string;
  Field bound;  ///< sum of the magnitudes in the node's row of K and of the couples of its rest, so that K <=
                ///< diag(bound) (Gershgorin) [N/m]

  bool bend() const noexcept { return !stiffness.empty(); }
};

/// Of a line that turns at rest: stiffness is k cos(theta_0), see rest_curvature.h.
BendingLines warpLines(const ClothPattern& pattern);
BendingLines weftLines(const ClothPattern& pattern);
/// The same into lines of this pattern, whose pins have changed. Allocates nothing.
void fillWarpLines(const ClothPattern& pattern, BendingLines& lines) noexcept;
void fillWeftLines(const ClothPattern& pattern, BendingLines& lines) noexcept;

/// Room for the moments of all lines; the lines of one block use their own part.
struct BendingScratch {
  Field x, y, z, give, per_rest, compliance;         // eight lines of the weft side by side
  Field pivot, near, far, border, last, mx, my, mz;  // elimination, moments

  void assign(const Grid& grid);
};

/// sum = force - K x of a block of columns (a cache line wide) of warp lines.
void bendWarp(const Grid& grid, const BendingLines& lines, const Field3& force, const Field3& position, int block,
              Field3& sum) noexcept;
/// What weft lines are computed with, by nodes: of the link on the left of each.
struct WeftShears {
  Field3 q;       ///< that it transmits [N]
  Field3 spared;  ///< what would press it together [N], see addShears()
};
/// Adds -K x of kLane rows, which are weft lines, from row block * kLane on, but for what is spared.
void bendWeft(const Grid& grid, const BendingLines& lines, const Field3& position, int block, WeftShears& shears,
              Field3& sum) noexcept;

/// Adds -A x to the force; give: of the nodes, in the layout of Field. kLane warp lines from column block * kLane on;
/// kLane weft lines from row block * kLane on, but for what is spared, or all of it.
void bendWarpGiving(const Grid& grid, const BendingLines& lines, const Field& give, const Field3& position, int block,
                    BendingScratch& scratch, Field3& force) noexcept;
void bendWeftGiving(const Grid& grid, const BendingLines& lines, const Field& give, const Field3& position, int block,
                    BendingScratch& scratch, bool spares, WeftShears& shears, Field3& force) noexcept;

/// Adds the shears q of kLane rows to the nodes; before that, if `spared` is not null, q loses to it the part that
/// presses together a link whose string holds it: all of it at its length, none where it is shorter by a hundredth,
/// since of slack links that part belongs to the potential. A line whose links keep their lengths has no use for that
/// part, which has no moment; strings do not hold against it, and would be shortened by the square of the turn.
void addShears(const Grid& grid, const Field& string, const Field3& position, int block, Field3& q, Field3* spared,
               Field3& sum) noexcept;
/// Work of the parts that were spared, over the links at these positions [J].
double workOfSpared(const Grid& grid, const Field3& spared, const Field3& position) noexcept;

/// The force of one weft line at one of its nodes, as bendWeft() has it [N].
Vec3 weftBendingAt(const Grid& grid, const BendingLines& lines, const Field3& position, int row, int column) noexcept;

}  // namespace curtain
