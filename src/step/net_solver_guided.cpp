// SPDX-License-Identifier: BSD-3-Clause
//
// Guided nodes in NetSolver: what the loops over nodes set up as if they were free, is set up again for them, with
// their matrices.
#include <algorithm>

#include "step/net_solver.h"

namespace curtain {
namespace {

template <typename Values3>
Vec3 vectorAt(const Values3& values, std::size_t k) {
  return {static_cast<double>(values.x[k]), static_cast<double>(values.y[k]), static_cast<double>(values.z[k])};
}

}  // namespace

// a^T W b at a node.
float NetSolver::through(int i, std::size_t j, const Vec3& a, const Vec3& b) const noexcept {
  const GuidedNode* const guided = guided_->at(i, static_cast<int>(j));
  return weight_[row(i) + j] * static_cast<float>(guided == nullptr ? a.dot(b) : a.dot(guided->freedom * b));
}

// A_ff at the links of guided nodes.
void NetSolver::loadGuided() noexcept {
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  guided_->forEach(0, pattern_.grid.columns, [&](const GuidedNode&, int i, int column) {
    const auto j = static_cast<std::size_t>(column);
    const auto setDiagonal = [&](std::size_t link) {
      const Vec3 along = vectorAt(weft_, row(i) + link);
      weft_diagonal_[row(i) + link] =
          through(i, link, along, along) + through(i, (link > 0 ? link : columns) - 1, along, along);
    };
    const std::size_t right = j + 1 < columns ? j + 1 : 0;
    if (j > 0 || pattern_.grid.closed) setDiagonal(j);
    if (right == 0 && !pattern_.grid.closed) return;
    setDiagonal(right);
    weft_off_[row(i) + j] = -through(i, j, vectorAt(weft_, row(i) + j), vectorAt(weft_, row(i) + right));
  });
}

// A_ww at the rods of a block from row i - 1 to i that end at a guided node. off, lower: of row i, for the rods below.
void NetSolver::factorGuided(int block, int i, float* off, float* lower) noexcept {
  const auto factor = [&](const GuidedNode&, int column) {
    const auto j = static_cast<std::size_t>(column);
    const std::size_t k = row(i) + j, lane = j % kColumns;
    const Vec3 rod = vectorAt(warp_, k);
    const float diagonal = through(i - 1, j, rod, rod) + through(i, j, rod, rod);
    const float pivot = diagonal + through(i - 1, j, vectorAt(warp_, k - stride_), rod) * warp_lower_[k - stride_];
    const float smallest = kSmallestPivot * (weight_[k] + weight_[k - stride_]);
    warp_inverse_[k] = diagonal > 0.0F ? 1.0F / std::max(pivot, smallest) : 0.0F;
    off[lane] = -through(i, j, rod, vectorAt(warp_, k + stride_));
    warp_lower_[k] = lower[lane] = off[lane] * warp_inverse_[k];
  };
  const int first = block * kColumns, end = std::min(first + kColumns, pattern_.grid.columns);
  guided_->forEach(i - 1, first, end, factor);
  guided_->forEach(i, first, end, factor);
}

// A_wf at guided nodes.
void NetSolver::coupleGuided(int block) noexcept {
  const int begin = block * kColumns, end = std::min(begin + kColumns, pattern_.grid.columns);
  guided_->forEach(begin, end, [&](const GuidedNode& guided, int i, int column) {
    const auto j = static_cast<std::size_t>(column);
    const std::size_t k = row(i) + j;
    const double w = static_cast<double>(weight_[k]);
    const Vec3 left = w * guided.freedom * vectorAt(weft_, k), right = w * guided.freedom * vectorAt(weft_, k + 1);
    const Vec3 above = vectorAt(warp_, k), below = vectorAt(warp_, k + stride_);
    above_left_[k] = static_cast<float>(above.dot(left));
    above_right_[k] = -static_cast<float>(above.dot(right));
    below_left_[k] = -static_cast<float>(below.dot(left));
    below_right_[k] = static_cast<float>(below.dot(right));
  });
}

// A string between nodes that both stay can't be changed.
void NetSolver::leaveOutFixedLinks() noexcept {
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  guided_->forEach(0, pattern_.grid.columns, [&](const GuidedNode&, int i, int column) {
    const auto j = static_cast<std::size_t>(column);
    for (const std::size_t link : {j, j + 1 < columns ? j + 1 : 0}) {
      if (!(weft_diagonal_[row(i) + link] > 0.0F)) mask_[row(i) + link] = residual_[row(i) + link] = 0.0F;
    }
  });
}

// Of vectors at the guided nodes of columns [first, end), leaves what moves them.
void NetSolver::keepFreedom(Values3& vectors, int first, int end) noexcept {
  guided_->forEach(first, std::min(end, pattern_.grid.columns), [&](const GuidedNode& guided, int i, int column) {
    const std::size_t k = row(i) + static_cast<std::size_t>(column);
    const Vec3 kept = guided.freedom * vectorAt(vectors, k);
    vectors.x[k] = static_cast<float>(kept.x());
    vectors.y[k] = static_cast<float>(kept.y());
    vectors.z[k] = static_cast<float>(kept.z());
  });
}

}  // namespace curtain
