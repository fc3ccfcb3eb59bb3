// SPDX-License-Identifier: BSD-3-Clause
//
// Carriers in NetSolver: what the loops over nodes set up as if they were free, is set up anew for their nodes, with
// the inverse inertia w tangent tangent^T.
#include "solver/net_solver.h"

namespace curtain {
namespace {

template <typename Values3>
Vec3 vectorAt(const Values3& values, std::size_t k) {
  return {static_cast<double>(values.x[k]), static_cast<double>(values.y[k]), static_cast<double>(values.z[k])};
}

}  // namespace

// a^T W b at a node of the top row.
float NetSolver::throughTop(int column, const Vec3& a, const Vec3& b) const noexcept {
  const Carrier* const carrier = carriers_->at(column);
  if (carrier == nullptr) return weight_[static_cast<std::size_t>(column)] * static_cast<float>(a.dot(b));
  return static_cast<float>(carrier->mobility / inertia_scale_ * a.dot(carrier->along) * b.dot(carrier->along));
}

// A_ff at the links of carriers.
void NetSolver::takeCarriers() noexcept {
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  for (const Carrier& carrier : carriers_->all()) {
    const int column = carrier.column;
    const auto j = static_cast<std::size_t>(column);
    const Vec3 left = vectorAt(weft_, j), right = vectorAt(weft_, j + 1);
    if (j > 0) weft_diagonal_[j] = throughTop(column, left, left) + throughTop(column - 1, left, left);
    if (j + 1 == columns) continue;
    weft_off_[j] = -throughTop(column, left, right);
    weft_diagonal_[j + 1] = throughTop(column, right, right) + throughTop(column + 1, right, right);
  }
}

// A_ww at the rods that hang from carriers.
void NetSolver::factorCarriers(int block, float* lower_above) noexcept {
  carriers_->forEach(block * kColumns, (block + 1) * kColumns, [&](const Carrier& carrier) {
    const std::size_t k = row(1) + static_cast<std::size_t>(carrier.column);
    const Vec3 rod = vectorAt(warp_, k);
    const float pivot = weight_[k] * static_cast<float>(rod.squaredNorm()) + throughTop(carrier.column, rod, rod);
    const float off = -weight_[k] * static_cast<float>(rod.dot(vectorAt(warp_, k + stride_)));
    warp_inverse_[k] = pivot > 0.0F ? 1.0F / pivot : 0.0F;
    warp_lower_[k] = lower_above[carrier.column % kColumns] = off * warp_inverse_[k];
  });
}

// A_wf at carriers.
void NetSolver::coupleCarriers(int block) noexcept {
  carriers_->forEach(block * kColumns, (block + 1) * kColumns, [&](const Carrier& carrier) {
    const auto j = static_cast<std::size_t>(carrier.column);
    const Vec3 rod = vectorAt(warp_, row(1) + j);
    below_left_[j] = -throughTop(carrier.column, rod, vectorAt(weft_, j));
    below_right_[j] = throughTop(carrier.column, rod, vectorAt(weft_, j + 1));
  });
}

// A string between carriers that both stay can't be changed.
void NetSolver::leaveOutFixedLinks() noexcept {
  for (const Carrier& carrier : carriers_->all()) {
    const auto j = static_cast<std::size_t>(carrier.column);
    if (!(weft_diagonal_[j] > 0.0F)) mask_[j] = residual_[j] = 0.0F;
  }
}

// Of vectors at the carriers of columns [first, end), leaves what moves them.
void NetSolver::keepOnRail(Values3& vectors, int first, int end) noexcept {
  carriers_->forEach(first, end, [&](const Carrier& carrier) {
    const auto j = static_cast<std::size_t>(carrier.column);
    const Vec3 kept =
        carrier.mobility > 0.0 ? Vec3(carrier.along.dot(vectorAt(vectors, j)) * carrier.along) : Vec3(Vec3::Zero());
    vectors.x[j] = static_cast<float>(kept.x());
    vectors.y[j] = static_cast<float>(kept.y());
    vectors.z[j] = static_cast<float>(kept.z());
  });
}

}  // namespace curtain
