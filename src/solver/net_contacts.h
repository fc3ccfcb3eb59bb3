// SPDX-License-Identifier: BSD-3-Clause
//
// The contacts' rows of NetSolver's conjugate gradients: one along the normal of every contact that pushes or
// penetrates, and two tangential ones where it sticks. Jacobi-preconditioned. Single precision, like all of NetSolver.
#pragma once

#include <vector>

#include "solver/contacts.h"

namespace curtain {

/// Nodal vectors in NetSolver's layout.
struct NetNodes {
  float* x;
  float* y;
  float* z;
};

/// Contacts, and the values that their violations are measured on; contacts may be null.
struct ContactValues {
  const Contacts* contacts = nullptr;
  const Field3* value = nullptr;  ///< positions, or (rates) velocities
  bool rates = false;
};

class NetContacts {
 public:
  /// Scaling and layout of NetSolver.
  struct Frame {
    const Grid& grid;
    std::size_t stride;      ///< of NetSolver's rows
    const float* weight;     ///< of its nodes: inverse inertia over inertia_scale
    double inertia_scale;    ///< [1/kg]
    double violation_scale;  ///< [m]
    float damping;           ///< Levenberg-Marquardt, over the diagonal
  };

  /// Builds the rows of the contacts that take part.
  void load(const Frame& frame, const ContactValues& values);
  /// Reserves room for the rows of so many contacts.
  void reserve(std::size_t contacts) { rows_.reserve(3 * contacts); }
  bool any() const noexcept { return !rows_.empty(); }
  /// Calls take(node), in NetSolver's numbering, for the nodes of all rows; a node may come more than once.
  template <typename Take>
  void forEachNode(const Take& take) const {
    for (const Row& row : rows_) {
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

  /// The solution, contact by contact: take(index, change of push [kg m], change of slide [kg m]).
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
    float diagonal, per_diagonal;  // the second: inverse, with damping
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
