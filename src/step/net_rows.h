// SPDX-License-Identifier: BSD-3-Clause
//
// The further rows of NetSolver's conjugate gradients. Those with a lower bound only pull, like the
// weft's strings, and which of them take part is found during the solve. Preconditioned, and damped, by the diagonal;
// what couples them is left to the gradients. Single precision, like all of NetSolver.
#pragma once

#include <algorithm>

#include "cloth/workers.h"
#include "step/row.h"

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
    std::uint32_t grid_stride;
    std::uint32_t stride;    ///< of NetSolver's rows
    double inertia_scale;    ///< [1/kg]
    double violation_scale;  ///< [m]
    float damping;           ///< Levenberg-Marquardt, over the diagonal
  };

  /// workers must outlive this.
  explicit NetRows(const Workers& workers) : workers_(workers) {}

  void reserve(std::size_t rows) {
    rows_.reserve(rows);
    terms_.reserve(rows);
  }

  /// Takes the rows that are active, and if the active set may change all others. diagonal(row, nodes): by how much its
  /// multiplier moves a row along itself, over the inertia scale; nodes: in NetSolver's numbering.
  template <typename Diagonal>
  void load(const Frame& frame, const Rows& rows, bool set_may_change, const Diagonal& diagonal) {
    rows_.clear();
    aligned_ = 0.0;
    for (std::uint32_t index = 0; index < rows.size(); ++index) {
      const Row& row = rows[index];
      if (!row.active && !set_may_change) continue;
      Packed& packed = rows_.emplace_back();
      packed.index = index;
      packed.nodes = row.nodes;
      for (std::size_t k = 0; k < static_cast<std::size_t>(row.nodes); ++k) {
        packed.node[k] = row.node[k] / frame.grid_stride * frame.stride + row.node[k] % frame.grid_stride;
        packed.weight[k] = static_cast<float>(row.weight[k]);
      }
      packed.diagonal = diagonal(row, packed.node);
      if (packed.diagonal > 0.0F)
        scale(frame, row, packed);
      else
        rows_.pop_back();  // no node of it can move
    }
  }
  bool any() const noexcept { return !rows_.empty(); }
  /// Calls visit(node), in NetSolver's numbering, for the nodes of all rows; a node may come more than once.
  template <typename Visit>
  void forEachNode(const Visit& visit) const {
    for (const Packed& row : rows_) {
      for (int k = 0; k < row.nodes; ++k) visit(row.node[static_cast<std::size_t>(k)]);
    }
  }

  /// Residual . residual over the diagonal (the preconditioned residual norm).
  double aligned() const noexcept { return aligned_; }
  /// Sets the next search direction, and adds its nodal impulses to push.
  void turn(float beta, NetNodes push) noexcept;
  /// Search direction . (matrix times search direction), from the nodes' moves.
  double product(NetNodes move) noexcept;
  /// Makes a step along the search direction; returns the largest residual left.
  double advance(float alpha) noexcept;

  /// Number of rows that are below their bound, or violated and not active.
  int countChanges(float goal) const noexcept;
  /// Applies these changes; the search direction is what brings leaving rows to their bound. Returns how many leave.
  int changeSet(float goal, NetNodes push) noexcept;

  /// Brings the solution within its bound and adds its nodal impulses to push.
  void conclude(NetNodes push) noexcept;
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
    float compliance;                       // over the inertia scale
    float damping, diagonal, per_diagonal;  // the last: inverse, with damping
    float residual, pull, product, solution;
    float least;  // lower bound of the solution

    void push(float multiplier, NetNodes push) const noexcept {
      for (std::size_t k = 0; k < static_cast<std::size_t>(nodes); ++k) {
        const float share = multiplier * weight[k];
        push.x[node[k]] += share * dx;
        push.y[node[k]] += share * dy;
        push.z[node[k]] += share * dz;
      }
    }
    // What has left is at its bound, to which gradients bring it but for rounding.
    float bounded() const noexcept { return on > 0.0F ? std::max(solution, least) : least; }
    double aligned() const noexcept { return static_cast<double>(on * residual * residual * per_diagonal); }
  };

  void scale(const Frame& frame, const Row& row, Packed& packed) noexcept;

  const Workers& workers_;
  std::vector<Packed> rows_;
  std::vector<double> terms_;  // of the sum of product()
  double aligned_ = 0.0;
};

}  // namespace curtain
