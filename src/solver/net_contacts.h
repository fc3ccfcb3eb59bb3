// SPDX-License-Identifier: BSD-3-Clause
//
// The contacts' share of NetSolver's conjugate gradients: a row along the normal of every contact that pushes or is
// entered, and two across it where the point sticks. Preconditioned each by itself. Single precision, like all of
// NetSolver.
#pragma once

#include <vector>

#include "solver/contacts.h"

namespace curtain {

/// Nodal vectors as NetSolver lays them out.
struct NetNodes {
  float* x;
  float* y;
  float* z;
};

/// Contacts and what their violations are measured on; contacts may be null: none.
struct ContactValues {
  const Contacts* contacts = nullptr;
  const Field3* value = nullptr;  ///< positions, or (rates) velocities
  bool rates = false;
};

class NetContacts {
 public:
  /// How numbers are scaled in NetSolver, and where nodes lie.
  struct Frame {
    const Grid& grid;
    std::size_t stride;      ///< of NetSolver's rows
    const float* weight;     ///< of its nodes: inverse inertia over inertia_scale
    double inertia_scale;    ///< [1/kg]
    double violation_scale;  ///< [m]
    float damping;           ///< Levenberg-Marquardt, over the diagonal
  };

  /// Rows of the contacts that take part.
  void load(const Frame& frame, const ContactValues& values);
  /// Room for the rows of so many contacts.
  void reserve(std::size_t contacts) { rows_.reserve(3 * contacts); }
  bool any() const noexcept { return !rows_.empty(); }
  /// Calls take(node), as numbered in NetSolver, for the nodes of all rows, some of them more than once.
  template <typename Take>
  void forEachNode(const Take& take) const {
    for (const Row& row : rows_) {
      for (int k = 0; k < row.nodes; ++k) take(row.node[static_cast<std::size_t>(k)]);
    }
  }

  /// Residual . residual over the diagonal.
  double aligned() const noexcept { return aligned_; }
  /// The next search direction, and the nodes' shares of it added to push.
  void turn(float beta, NetNodes push) noexcept;
  /// Search direction . its product, from the moves of the nodes; push is zero again.
  double product(NetNodes move, NetNodes push) noexcept;
  /// A step along the search direction; returns the largest residual left.
  double advance(float alpha) noexcept;

  /// What came out, contact by contact: f(index, change of push [kg m], change of slide [kg m]).
  template <typename Take>
  void forEachChange(double scale, const Take& take) const;

 private:
  struct Row {
    std::uint32_t contact;
    int nodes;
    std::array<std::uint32_t, 4> node;  // in NetSolver's layout
    std::array<float, 4> weight;
    float dx, dy, dz;  // direction of the multiplier
    bool normal;
    float diagonal, per_diagonal;  // the second with the damping
    float residual, pull, product, solution;
  };

  void addRow(const Frame& frame, std::uint32_t index, const Contact& contact, const Vec3& direction, double wanted,
              bool normal);

  std::vector<Row> rows_;
  float damping_ = 0.0F;
  double aligned_ = 0.0;
};

template <typename Take>
void NetContacts::forEachChange(double scale, const Take& take) const {
  for (std::size_t r = 0; r < rows_.size();) {
    const std::uint32_t contact = rows_[r].contact;
    double push = 0.0;
    Vec3 slide = Vec3::Zero();
    for (; r < rows_.size() && rows_[r].contact == contact; ++r) {
      const double change = scale * static_cast<double>(rows_[r].solution);
      if (rows_[r].normal)
        push += change;
      else
        slide += change * Vec3(rows_[r].dx, rows_[r].dy, rows_[r].dz);
    }
    take(contact, push, slide);
  }
}

}  // namespace curtain
