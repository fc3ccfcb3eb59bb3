// SPDX-License-Identifier: BSD-3-Clause
//
// The cords' rows of NetSolver's conjugate gradients: one along each cord. Like the weft's strings they only pull, and
// which of them take part is found during the solve. Preconditioned, and damped, by the diagonal of the Schur
// complement itself: where a cord continues a taut column, it is the end's mobility alone, a small part of the node's.
// What a common end couples is left to the gradients. Single precision, like all of NetSolver.
#pragma once

#include <vector>

#include "solver/cord_links.h"
#include "solver/net_contacts.h"

namespace curtain {

class NetCords {
 public:
  /// Allocates for so many cords.
  explicit NetCords(std::size_t cords) { rows_.resize(cords); }

  /// Builds the rows. bounded: no multiplier may end below zero, and cords that get too long join. mobility(node,
  /// along): by how much an impulse along it moves a node that the rods hold, over the inertia scale.
  template <typename Mobility>
  void load(const NetContacts::Frame& frame, const std::vector<CordLink>& cords, bool bounded,
            const Mobility& mobility) noexcept {
    begin(frame, bounded);
    for (std::size_t c = 0; c < cords.size(); ++c) {
      Row& row = rows_[c];
      setPlace(frame, cords[c], row);
      const Vec3 along(static_cast<double>(row.dx), static_cast<double>(row.dy), static_cast<double>(row.dz));
      const double own = cords[c].ties ? mobility(row.node, along) : 0.0;
      take(frame, cords[c], static_cast<float>(own), row);
    }
  }
  /// A cord takes part.
  bool any() const noexcept { return any_; }
  /// Calls take(node), in NetSolver's numbering, for the nodes and ends of all cords.
  template <typename Take>
  void forEachNode(const Take& take) const {
    for (const Row& row : rows_) {
      take(row.node);
      take(row.end);
    }
  }

  /// As NetContacts.
  double aligned() const noexcept { return aligned_; }
  void turn(float beta, NetNodes push) noexcept;
  double product(NetNodes move, NetNodes push) noexcept;
  double advance(float alpha) noexcept;

  /// Number of cords that would push, or have become too long.
  int countChanges(float goal) const noexcept;
  /// Applies these changes; the search direction is what brings leaving cords to multiplier zero. Returns how many.
  int changeSet(float goal, NetNodes push) noexcept;

  /// Ends a solve for positions: no multiplier ends below zero. Adds the solution's nodal impulses to push.
  void conclude(NetNodes push) noexcept;
  /// The solution: take(index, change [kg]).
  template <typename Take>
  void forEachChange(double scale, const Take& take) const {
    for (std::size_t c = 0; c < rows_.size(); ++c) {
      if (rows_[c].solution != 0.0F) take(c, scale * static_cast<double>(rows_[c].solution) * rows_[c].per_length);
    }
  }

 private:
  struct Row {
    std::uint32_t node, end;  // in NetSolver's layout
    float dx, dy, dz;         // direction over length
    float on;                 // 1: takes part
    float diagonal, per_diagonal;
    float residual, pull, product, solution;
    float least;        // lower bound of the solution
    double per_length;  // [1/m]
  };

  void begin(const NetContacts::Frame& frame, bool bounded) noexcept;
  static void setPlace(const NetContacts::Frame& frame, const CordLink& cord, Row& row) noexcept;
  void take(const NetContacts::Frame& frame, const CordLink& cord, float mobility, Row& row) noexcept;

  std::vector<Row> rows_;
  bool bounded_ = false;
  float damping_ = 0.0F;
  double aligned_ = 0.0;
  bool any_ = false;
};

}  // namespace curtain
