// SPDX-License-Identifier: BSD-3-Clause
//
// All taut links at once, linearised. With the rods eliminated (a tridiagonal system a column) the taut strings'
// multipliers t solve the Schur complement
//     S t = g,   S = A_ff - A_fw A_ww^-1 A_wf,   A = N W N^T   (f: weft, w: warp; N: directions, W: inverse inertia)
// by conjugate gradients, preconditioned with the rows' own tridiagonal systems A_ff. What else constrains the cloth is
// further rows of f (Row). An iteration is one warp and one weft sweep. Alternating the two without conjugation
// converges as cos^2 of the angle between warp and weft; with sheared cloth this takes about the square root of that
// number of sweeps.
//
// Strings only pull: which of them take part is found during the solve, by a primal-dual active set method
// (Hintermueller, Ito, Kunisch 2002). Where the residual is reduced far enough, strings that would push leave, strings
// that are too long join, and the gradients start again.
//
// Single precision: a solve is a step of an iteration whose residual is measured in double, so rounding only leaves the
// next step a little more to do. Directions are scaled by the rest lengths and inertia by its largest, so that numbers
// are near one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "cloth/cloth.h"
#include "cloth/workers.h"
#include "step/guided_nodes.h"
#include "step/net_rows.h"

namespace curtain {

class NetSolver {
 public:
  /// pattern and workers must outlive this.
  NetSolver(const ClothPattern& pattern, const Workers& workers);

  /// Reserves room for so many rows.
  void expectRows(std::size_t count) { rows_.reserve(count); }

  /// Sets the links' directions from these positions, and the nodes' inverse inertia [1/kg]. guided: those that do not
  /// move freely, with their freedom at these positions, or null.
  void begin(const Field3& position, const Field& inverse_inertia, const GuidedNodes* guided = nullptr) noexcept;

  /// Zeroes all vectors, e.g. after a solve with non-finite numbers.
  void reset() noexcept;

  /// Scale and termination of a solve.
  struct Aim {
    double largest;      ///< about the largest violation over a rest length [m], > 0: sets the scale of the numbers
    double damping;      ///< Levenberg-Marquardt term relative to the diagonal, [0..1): a flat net has about as many
                         ///< links as degrees of freedom in its plane, so some combinations of multipliers hardly
                         ///< move anything and would grow without bound
    double reduction;    ///< of the residual at which to stop, (0..1)
    int max_iterations;  ///< > 0
    const Field* multiplier = nullptr;  ///< of the strings [kg]: none may end below zero; null: no bound
    const Field* compliance = nullptr;  ///< of the strings, over the diagonal; violations have it in them. null: 0
  };
  struct Outcome {
    int iterations = 0;
    double reduction = 0.0;  ///< largest residual left over the largest at the start
  };
  /// violation  C = (|r|^2 - l^2) / 2 [m^2] (or its rate) of the links; shape of the grid, stored at the right node
  /// active     1 for the links that take part, 0 for the others; with Aim::multiplier, at the start
  /// rows       the further rows; their changes are set. With Aim::multiplier, rows that are not active may join if no
  ///            row has a least damping: such rows are damped too much to find the active set
  /// change     out: change of the strings' multipliers [kg] (or its rate) that removes the violations while the rods
  ///            keep theirs
  Outcome solve(const Field& violation, const Field& active, Rows& rows, const Aim& aim, Field& change) noexcept;

  /// The change of the rods' multipliers [kg] that keeps their lengths under these changes of strings, the last
  /// solve()'s within their bounds, and under those of the rows, which are brought within theirs first. out: shape of
  /// the grid. What rows with a heavy load pull by, and the rods pull back, is far larger than what both leave: nodes
  /// are to be moved by all together.
  void rodsAnswer(const Field& strings, Rows& rows, Field& out) noexcept;

 private:
  using Real = float;
  static constexpr int kColumns = 16;             // of a block, side by side in the warp's sweeps
  static constexpr int kRows = 8;                 // of a block, side by side in the weft's sweeps
  static constexpr float kSmallestPivot = 1e-6F;  // over (w_a + w_b): ten roundings of a float

  using Values = std::vector<Real, CacheAligned<Real>>;
  struct Values3 {
    Values x, y, z;
  };

  void loadRow(const Field3& position, const Field& inverse_inertia, int row) noexcept;
  void factorWarp(int block) noexcept;
  void factorWeft(int row_block) noexcept;
  void load(const Field& violation, const Field& active, const Aim& aim, int row_block) noexcept;
  void unload(int row_block, const Field* multiplier, Field& change) noexcept;
  void couple(int block) noexcept;
  void answerOfRods(int block) noexcept;
  void moveNodes(int block) noexcept;
  double schurProduct(int row_block) noexcept;
  double advance(int row_block, Real alpha) noexcept;
  double precondition(int row_block) noexcept;
  void conjugate(int row_block, Real beta) noexcept;
  void addPushes(int row) noexcept;
  float through(int i, std::size_t j, const Vec3& a, const Vec3& b) const noexcept;
  void loadGuided() noexcept;
  void factorGuided(int block, int i, float* off, float* lower) noexcept;
  void coupleGuided(int block) noexcept;
  void leaveOutFixedLinks() noexcept;
  void keepFreedom(Values3& vectors, int first, int end) noexcept;
  void findPushed() noexcept;
  void loadRows(const Rows& rows, bool set_may_change) noexcept;
  double mobilityOf(std::uint32_t node, const Vec3& along) const noexcept;
  NetNodes pushes() noexcept { return {push_.x.data(), push_.y.data(), push_.z.data()}; }
  bool isPushed(int row, int block) const noexcept {
    return pushed_[static_cast<std::size_t>(row * (static_cast<int>(stride_) / kColumns) + block)] != 0;
  }
  double applySchur() noexcept;
  double step(Real alpha) noexcept;
  bool changeStrings(Real goal) noexcept;
  double countChanges(int row_block, Real goal) const noexcept;
  double changeSet(int row_block, Real goal) noexcept;
  void closeRows(Values& links) noexcept;
  template <typename Block>
  double sumOverRowBlocks(const Block& block) noexcept;

  std::array<Values*, 33> allVectors() noexcept;
  double multiplierScale() const noexcept { return violation_scale_ / inertia_scale_; }
  std::size_t row(int i) const { return static_cast<std::size_t>(i) * stride_; }

  const ClothPattern& pattern_;
  const Workers& workers_;
  std::size_t stride_;  // a row's nodes, the link that closes a ring, padding
  int row_blocks_, column_blocks_;
  double inertia_scale_ = 1.0;  // the largest inverse inertia [1/kg]
  double violation_scale_ = 1.0;
  Real damping_ = 0.0F;
  Field per_warp_rest_, per_weft_rest_;  // [1/m]
  Values weight_;                        // inverse inertia over the largest
  Values3 warp_, weft_;                  // directions over rest lengths; weft: one more link for the ring
  Values warp_inverse_, warp_lower_;     // A_ww = L D L^T by column: 1 / D, and L below the diagonal
  Values weft_diagonal_, weft_off_;      // A_ff: diagonal, entry towards the next link
  Values damped_;                        // its diagonal with damping and compliance
  Values weft_inverse_, weft_lower_;     // A_ff = L D L^T by row; interleaved over the rows of a block
  Values above_left_, above_right_;      // A_wf at a node: the rod above with the link on the left, on the right
  Values below_left_, below_right_;      // the same for the rod below
  Values rods_;                          // A_ww^-1 A_wf pull_: minus the change of the rods' multipliers
  Values3 move_;                         // of the nodes of rows_
  Values3 push_;                         // nodal impulses of their search direction; zero outside a product
  NetRows rows_;
  const GuidedNodes* guided_ = nullptr;
  std::vector<std::uint8_t> pushed_;  // by row and block of columns: it has a node of rows_
  Values mask_, residual_, preconditioned_, pull_, product_, solution_;
  Values least_;                    // lower bound of the solution: minus the multipliers
  Values interleaved_;              // scratch of precondition()
  std::vector<std::uint8_t> taut_;  // row blocks with a link that takes part
  std::vector<double> partial_;     // sums of the row blocks
  std::vector<double> changed_;     // links of the row blocks that leave or join
};

}  // namespace curtain
