// SPDX-License-Identifier: BSD-3-Clause
//
// All taut links at once, to first order. With the rods eliminated (a tridiagonal system a column) what is left for the
// taut strings' multipliers t is the Schur complement
//     S t = g,   S = A_ff - A_fw A_ww^-1 A_wf,   A = N W N^T   (f: weft, w: warp; N: directions, W: inverse inertia),
// solved by conjugate gradients, preconditioned with the rows' own tridiagonal systems A_ff. Contacts that push are
// further rows of f, with their normals (and, where they stick, two directions across) for the links' directions. An
// iteration is one warp and one weft sweep. Alternating the two without conjugation converges as cos^2 of the angle
// between warp and weft; where they are sheared this takes about the square root of that number of sweeps.
//
// Strings only pull, so which of them take part is found as the solve goes (a primal-dual active set: Hintermueller,
// Ito, Kunisch
// 2002): where conjugate gradients have come as far as the residual's change of size allows, those that would push
// leave with nothing, those that have become too long join, and the gradients begin anew.
//
// All in single precision: a solve is a step of an iteration whose residual is measured in double, so rounding costs
// nothing but that the next step has a little more to do. Directions are over the rest lengths and inertia over its
// largest, so that numbers are near one.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/cloth.h"
#include "cloth/column_set.h"
#include "solver/net_contacts.h"
#include "solver/workers.h"

namespace curtain {

class NetSolver {
 public:
  /// pattern and workers must outlive this.
  NetSolver(const ClothPattern& pattern, const Workers& workers);

  /// Room for so many contacts.
  void expectContacts(std::size_t count) { contacts_.reserve(count); }

  /// Takes the links' directions from these positions, and how nodes answer impulses [1/kg]. Outside the span nothing
  /// moves; before it changes: reset().
  void begin(const Field3& position, const Field& inverse_inertia, const ColumnSpan& span) noexcept;

  /// Forgets all numbers (after one that was not finite).
  void reset() noexcept;

  /// What a solve is for and when it has done enough.
  struct Aim {
    double largest;       ///< about the largest violation over a rest length [m] (sets the scale of the numbers), > 0
    double damping;       ///< Levenberg-Marquardt term over the diagonal, [0..1): a flat net has about as many links as
                          ///< freedoms in its plane, so some combinations of multipliers hardly move anything and would
                          ///< grow without bound
    double reduction;     ///< of the residual that is enough, (0..1)
    int most_iterations;  ///< > 0
    const Field* multiplier = nullptr;  ///< of the strings [kg]: none may end below zero; null: they may
  };
  struct Outcome {
    int iterations = 0;
    double reduction = 0.0;  ///< largest residual left over the largest at the start
  };
  /// violation        C = (|r|^2 - l^2) / 2 [m^2] (or its rate) of the links; shape of the grid, stored at the right
  ///                  node
  /// active           1 for the links that take part, 0 for the others; with Aim::multiplier, to begin with
  /// contacts         those that push or are entered take part
  /// change           of the strings' multipliers [kg] (or its rate), that takes the violations away while the rods
  ///                  keep theirs
  Outcome solve(const Field& violation, const Field& active, const ContactValues& contacts, const Aim& aim,
                Field& change) noexcept;

  /// The same of the contacts, after solve(): take(index, change of push, change of slide).
  template <typename Take>
  void forEachContactChange(const Take& take) const {
    contacts_.forEachChange(multiplierScale(), take);
  }

 private:
  using Real = float;
  static constexpr int kColumns = 16;             // of a block, swept side by side along the warp
  static constexpr int kRows = 8;                 // of a block, solved side by side along the weft
  static constexpr float kSmallestPivot = 1e-6F;  // of single precision's rounding, over (w_a + w_b)

  using Values = std::vector<Real, CacheAligned<Real>>;
  struct Values3 {
    Values x, y, z;
  };

  void takeRow(const Field3& position, const Field& inverse_inertia, const ColumnSpan& span, int row) noexcept;
  void factorWarp(int block) noexcept;
  void factorWeft(int row_block) noexcept;
  void load(const Field& violation, const Field& active, const Field* multiplier, int row_block) noexcept;
  void unload(int row_block, const Field* multiplier, Field& change) noexcept;
  void couple(int block) noexcept;
  void answerOfRods(int block) noexcept;
  void moveNodes(int block) noexcept;
  double schurProduct(int row_block) noexcept;
  double advance(int row_block, Real alpha) noexcept;
  double precondition(int row_block) noexcept;
  void conjugate(int row_block, Real beta) noexcept;
  void addPushes(int row) noexcept;
  void findPushed() noexcept;
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

  double multiplierScale() const noexcept { return violation_scale_ / inertia_scale_; }
  std::size_t row(int i) const { return static_cast<std::size_t>(i) * stride_; }

  const ClothPattern& pattern_;
  const Workers& workers_;
  std::size_t stride_;                       // a row's nodes, one more link, padding
  int first_block_ = 0, moving_blocks_ = 0;  // of columns
  int row_blocks_;
  double inertia_scale_ = 1.0;  // the largest inverse inertia [1/kg]
  double violation_scale_ = 1.0;
  Real damping_ = 0.0F;
  Field per_warp_rest_, per_weft_rest_;  // [1/m]
  Values weight_;                        // inverse inertia over the largest
  Values3 warp_, weft_;                  // directions over rest lengths; weft: one more link closes the ring
  Values warp_inverse_, warp_lower_;     // A_ww = L D L^T by column: 1 / D, and L below the diagonal
  Values weft_diagonal_, weft_off_;      // A_ff: diagonal, entry towards the next link
  Values weft_inverse_, weft_lower_;     // A_ff = L D L^T by row; interleaved over the rows of a block
  Values above_left_, above_right_;      // A_wf, at a node: of the rod above it with the link on its left, on its right
  Values below_left_, below_right_;      // the same of the rod below it
  Values rods_;                          // A_ww^-1 A_wf pull_: minus what the rods' multipliers change by
  Values3 move_;                         // of the nodes, where contacts ask for it
  Values3 push_;                         // the contacts' search direction on the nodes; zero outside a product
  NetContacts contacts_;
  std::vector<std::uint8_t> pushed_;  // by row and block of columns: a contact has a node there
  Values mask_, residual_, preconditioned_, pull_, product_, solution_;
  Values least_;                    // that the solution may be: minus the multipliers
  Values interleaved_;              // scratch of precondition()
  std::vector<std::uint8_t> taut_;  // row blocks with a link that takes part
  std::vector<double> partial_;     // sums of the row blocks
  std::vector<double> changed_;     // links of the row blocks that leave or join
};

}  // namespace curtain
