// SPDX-License-Identifier: BSD-3-Clause
//
// The rows of contacts and cords in NetSolver's conjugate gradients. Those with a lower bound only pull, like the
// weft's strings, and which of them take part is found during the solve. Preconditioned, and damped, by the diagonal;
// what couples them is left to the gradients. Single precision, like all of NetSolver.
#pragma once

#include "solver/row.h"

namespace curtain {

/// Nodal vectors in NetSolver's layout.
struct NetNodes {
  float* x;
  float* y;
  float* z;
};

class NetRows {
 public:
  /// Scaling and layout of NetSolver.
  struct Frame {
    std::size_t grid_stride;
    std::size_t stride;      ///< of NetSolver's rows
    double inertia_scale;    ///< [1/kg]
    double violation_scale;  ///< [m]
    float damping;           ///< Levenberg-Marquardt, over the diagonal
  };

  void reserve(std::size_t rows) { rows_.reserve(rows); }

  /// Takes the rows that are active, and if the active set may change all others. mobility(row, node, direction): by
  /// how much an impulse along it moves a node of this number in NetSolver along it, over the inertia scale.
  template <typename Mobility>
  void load(const Frame& frame, const Rows& rows, bool set_may_change, const Mobility& mobility) {
    rows_.clear();
    aligned_ = 0.0;
    for (std::uint32_t index = 0; index < rows.size(); ++index) {
      if (!rows[index].active && !set_may_change) continue;
      Packed packed = pack(frame, rows[index]);
      packed.index = index;
      for (int k = 0; k < packed.nodes; ++k) {
        const auto at = static_cast<std::size_t>(k);
        packed.diagonal += packed.weight[at] * packed.weight[at] * mobility(rows[index], packed.node[at]);
      }
      add(packed);
    }
  }
  bool any() const noexcept { return !rows_.empty(); }
  /// Calls take(node), in NetSolver's numbering, for the nodes of all rows; a node may come more than once.
  template <typename Take>
  void forEachNode(const Take& take) const {
    for (const Packed& row : rows_) {
      for (int k = 0; k < row.nodes; ++k) take(row.node[static_cast<std::size_t>(k)]);
    }
  }

  /// Residual . residual over the diagonal (the preconditioned residual norm).
  double aligned() const noexcept { return aligned_; }
  /// Sets the next search direction, and adds its nodal impulses to push.
  void turn(float beta, NetNodes push) noexcept;
  /// Search direction . (matrix times search direction), from the nodes' moves; zeroes push again.
  double product(NetNodes move, NetNodes push) noexcept;
  /// Makes a step along the search direction; returns the largest residual left.
  double advance(float alpha) noexcept;

  /// Number of rows that are below their bound, or violated and not active.
  int countChanges(float goal) const noexcept;
  /// Applies these changes; the search direction is what brings leaving rows to their bound. Returns how many leave.
  int changeSet(float goal, NetNodes push) noexcept;

  /// Of the rows with_rods: brings the solution within its bound and adds its nodal impulses to push.
  void conclude(const Rows& rows, NetNodes push) noexcept;
  /// Writes the solution to the rows that load() was given.
  void unload(double scale, Rows& rows) const noexcept;

 private:
  struct Packed {
    std::uint32_t index;  // of the row
    int nodes;
    std::array<std::uint32_t, 4> node;  // in NetSolver's layout
    std::array<float, 4> weight;
    float dx, dy, dz;
    float on;                               // 1: takes part
    float damping, diagonal, per_diagonal;  // the last: inverse, with damping
    float residual, pull, product, solution;
    float least;  // lower bound of the solution

    void push(float multiplier, NetNodes push) const noexcept;
    double aligned() const noexcept { return static_cast<double>(on * residual * residual * per_diagonal); }
  };

  static Packed pack(const Frame& frame, const Row& row) noexcept;
  void add(Packed row);

  std::vector<Packed> rows_;
  double aligned_ = 0.0;
};

}  // namespace curtain
