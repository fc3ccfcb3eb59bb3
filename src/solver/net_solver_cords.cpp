// SPDX-License-Identifier: BSD-3-Clause
//
// Cords in NetSolver: their ends, at which no rod or string ends, and what of a cord's node the rods leave free.
#include <algorithm>

#include "solver/net_solver.h"

namespace curtain {

void NetSolver::takeEnds(const Field& inverse_inertia) noexcept {
  for (const CordEnd& end : cord_links_->pattern().ends)
    weight_[placeOf(end.node)] = static_cast<float>(inverse_inertia[end.node] / inertia_scale_);
}

void NetSolver::moveEnds() noexcept {
  if (!cords_.any()) return;
  for (const CordEnd& end : cord_links_->pattern().ends) {
    const std::size_t k = placeOf(end.node);
    move_.x[k] = weight_[k] * push_.x[k];
    move_.y[k] = weight_[k] * push_.y[k];
    move_.z[k] = weight_[k] * push_.z[k];
  }
}

void NetSolver::loadCords(const NetContacts::Frame& frame, bool bounded) noexcept {
  if (cord_links_ == nullptr) return;
  cords_.load(frame, cord_links_->all(), bounded,
              [this](std::uint32_t node, const Vec3& along) { return mobilityOf(node, along); });
}

void NetSolver::answerSolution(Field& out) noexcept {
  pull_ = solution_;
  cords_.conclude(pushes());
  if (carriers_ != nullptr) keepOnRail(push_, 0, pattern_.grid.columns);
  closeRows(pull_);
  workers_.run(column_blocks_, [&](int b) { answerOfRods(b); });
  cords_.forEachNode([this](std::uint32_t n) { push_.x[n] = push_.y[n] = push_.z[n] = 0.0F; });
  const double scale = -multiplierScale();
  for (int i = 1; i < pattern_.grid.rows; ++i) {
    for (int j = 0; j < pattern_.grid.columns; ++j) {
      const std::size_t n = pattern_.grid.index(i, j);
      out[n] = scale * static_cast<double>(rods_[placeOf(n)]) * per_warp_rest_[n];
    }
  }
}

// along^T (W - W N^T A_ww^-1 N W) along at a node: by how much an impulse moves it along itself when the rods keep
// their lengths. A plumb column does not let its hem down at all. With A_ww = L D L^T the rods' part is the sum of y^2
// / D, y = L^-1 N W along, and y is 0 above the node.
double NetSolver::mobilityOf(std::uint32_t node, const Vec3& along) const noexcept {
  const auto rows = static_cast<std::size_t>(pattern_.grid.rows);
  const double w = static_cast<double>(weight_[node]);
  const auto through = [&](std::size_t k) {
    return w * (static_cast<double>(warp_.x[k]) * along.x() + static_cast<double>(warp_.y[k]) * along.y() +
                static_cast<double>(warp_.z[k]) * along.z());
  };
  double y = 0.0, held = 0.0;
  for (std::size_t i = std::max<std::size_t>(node / stride_, 1), k = i * stride_ + node % stride_; i < rows;
       ++i, k += stride_) {
    y = -static_cast<double>(warp_lower_[k - stride_]) * y;
    if (k == node) y += through(k);
    if (k == node + stride_) y -= through(k);
    held += y * y * static_cast<double>(warp_inverse_[k]);
  }
  return std::max(0.0, w * along.squaredNorm() - held);
}

}  // namespace curtain
