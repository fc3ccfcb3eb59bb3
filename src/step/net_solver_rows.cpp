// SPDX-License-Identifier: BSD-3-Clause
//
// An iteration of NetSolver's conjugate gradients: product with the Schur complement, preconditioner of the rows, and
// active set.
#include <algorithm>
#include <cmath>

#include "cloth/shuffle.h"
#include "cloth/wide.h"
#include "step/net_solver.h"

namespace curtain {
namespace {

constexpr std::size_t kInterleave = 8;                      // rows that are solved side by side
constexpr std::size_t kSquare = kInterleave * kInterleave;  // of as many of their columns; zeros beyond the last one

// Transposes an 8 x 8 block.
CURTAIN_INTO_WIDE void transpose(const float* from, std::size_t from_stride, float* to,
                                 std::size_t to_stride) noexcept {
  // Read and written as vectors, not by memcpy, which g++ makes single moves of for wide registers only.
  typedef float Lanes __attribute__((vector_size(32)));
  typedef float Unaligned __attribute__((vector_size(32), aligned(4), may_alias));
  static_assert(sizeof(Lanes) == kInterleave * sizeof(float), "a row of the block");
  Lanes a[kInterleave], b[kInterleave];
  for (std::size_t l = 0; l < kInterleave; ++l) a[l] = *reinterpret_cast<const Unaligned*>(from + l * from_stride);
  for (std::size_t l = 0; l < kInterleave; l += 2) {
    shuffle<0, 8, 1, 9, 4, 12, 5, 13>(a[l], a[l + 1], b[l]);
    shuffle<2, 10, 3, 11, 6, 14, 7, 15>(a[l], a[l + 1], b[l + 1]);
  }
  for (std::size_t l = 0; l < kInterleave; l += 4) {
    for (std::size_t m = 0; m < 2; ++m) {
      shuffle<0, 1, 8, 9, 4, 5, 12, 13>(b[l + m], b[l + m + 2], a[l + 2 * m]);
      shuffle<2, 3, 10, 11, 6, 7, 14, 15>(b[l + m], b[l + m + 2], a[l + 2 * m + 1]);
    }
  }
  for (std::size_t l = 0; l < kInterleave / 2; ++l) {
    shuffle<0, 1, 2, 3, 8, 9, 10, 11>(a[l], a[l + 4], b[l]);
    shuffle<4, 5, 6, 7, 12, 13, 14, 15>(a[l], a[l + 4], b[l + 4]);
  }
  for (std::size_t l = 0; l < kInterleave; ++l) *reinterpret_cast<Unaligned*>(to + l * to_stride) = b[l];
}

// Fixed number of partial sums, so the bits do not depend on the register width. count is a multiple of it.
CURTAIN_INTO_WIDE double dot(const float* a, const float* b, std::size_t count) noexcept {
  constexpr std::size_t kPartials = 16;
  float partials[kPartials] = {};
  for (std::size_t k = 0; k < count; k += kPartials) {
#pragma omp simd
    for (std::size_t l = 0; l < kPartials; ++l) partials[l] += a[k + l] * b[k + l];
  }
  double sum = 0.0;
  for (const float part : partials) sum += static_cast<double>(part);
  return sum;
}

}  // namespace

// LDL^T in the columns' order. That a ring's last link shares a node with the first is left to the conjugate gradients.
CURTAIN_WIDE void NetSolver::factorWeft(int b) noexcept {
  float off_before[kRows] = {};
  float lower_before[kRows] = {};
  const std::size_t first = row(b * kRows);
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  for (std::size_t block = 0; block < columns; block += kRows) {
    float diagonals[kSquare], offs[kSquare], ons[kSquare], ons_after[kSquare];
    transpose(&damped_[first + block], stride_, diagonals, kInterleave);
    transpose(&weft_off_[first + block], stride_, offs, kInterleave);
    transpose(&mask_[first + block], stride_, ons, kInterleave);
    transpose(&mask_[first + block + 1], stride_, ons_after, kInterleave);
    for (std::size_t j = 0; j < kSquare; j += kInterleave) {
      const float *const diagonal = diagonals + j, *const off = offs + j, *const on = ons + j,
                         *const on_after = ons_after + j;
      float* const inverse = &weft_inverse_[first + block * kInterleave + j];
      float* const lower = &weft_lower_[first + block * kInterleave + j];
#pragma omp simd
      for (std::size_t r = 0; r < kRows; ++r) {
        const float pivot = diagonal[r] - off_before[r] * lower_before[r];
        const float smallest = kSmallestPivot * diagonal[r];
        const float safe = pivot > smallest ? pivot : smallest;
        const float inverted = on[r] > 0.0F ? 1.0F / (safe > 0.0F ? safe : 1.0F) : 0.0F;
        const float coupling = on[r] * on_after[r] * off[r];
        inverse[r] = inverted;
        lower[r] = coupling * inverted;
        off_before[r] = coupling;
        lower_before[r] = coupling * inverted;
      }
    }
  }
}

// rods_ = the rods' response to pull_ (and to push_), for a block of columns.
CURTAIN_WIDE void NetSolver::answerOfRods(int block) noexcept {
  const std::size_t first = static_cast<std::size_t>(block) * kColumns;
  const int rows = pattern_.grid.rows;
  for (int i = 1; i < rows; ++i) {
    const std::size_t k = row(i) + first, above = k - stride_;
    const float *const p = &pull_[k], *const p_above = &pull_[above];
    const float *const above_left = &above_left_[k], *const above_right = &above_right_[k];
    const float *const below_left = &below_left_[above], *const below_right = &below_right_[above];
    const float* const lower_above = &warp_lower_[above];
    float* const s = &rods_[k];
    const float* const s_above = &rods_[above];
#pragma omp simd
    for (std::size_t j = 0; j < kColumns; ++j) {
      s[j] = above_left[j] * p[j] + above_right[j] * p[j + 1] + below_left[j] * p_above[j] +
             below_right[j] * p_above[j + 1] - lower_above[j] * s_above[j];
    }
    if (!rows_.any() || !(isPushed(i, block) || isPushed(i - 1, block))) continue;
    const float *const w = &weight_[k], *const w_above = &weight_[above];
    const float *const nx = &warp_.x[k], *const ny = &warp_.y[k], *const nz = &warp_.z[k];
    const float *const px = &push_.x[k], *const py = &push_.y[k], *const pz = &push_.z[k];
    const float *const ax = &push_.x[above], *const ay = &push_.y[above], *const az = &push_.z[above];
#pragma omp simd
    for (std::size_t j = 0; j < kColumns; ++j) {
      s[j] -= nx[j] * (w[j] * px[j] - w_above[j] * ax[j]) + ny[j] * (w[j] * py[j] - w_above[j] * ay[j]) +
              nz[j] * (w[j] * pz[j] - w_above[j] * az[j]);
    }
  }
  // No rod ends at the top row: rods_ stays 0 there.
  for (int i = rows - 1; i > 0; --i) {
    const std::size_t k = row(i) + first;
    const float *const inverse = &warp_inverse_[k], *const lower = &warp_lower_[k];
    float* const s = &rods_[k];
    const float* const s_below = s + stride_;
#pragma omp simd
    for (std::size_t j = 0; j < kColumns; ++j) s[j] = s[j] * inverse[j] - lower[j] * s_below[j];
  }
}

// move_ = displacement of a block's nodes, where rows_ are. Nothing reads push_ after it: zeroed again.
CURTAIN_WIDE void NetSolver::moveNodes(int block) noexcept {
  const std::size_t first = static_cast<std::size_t>(block) * kColumns;
  const auto move = [&](std::size_t k, const Values& warp, const Values& weft, Values& push, Values& out) {
    const float *const w = &weight_[k], *const p = &pull_[k], *const s = &rods_[k], *const s_below = s + stride_;
    const float *const n = &warp[k], *const b = n + stride_, *const f = &weft[k];
    float *const by = &push[k], *const u = &out[k];
#pragma omp simd
    for (std::size_t j = 0; j < kColumns; ++j) {
      u[j] = w[j] * (p[j + 1] * f[j + 1] - p[j] * f[j] + by[j] + (s[j] * n[j] - s_below[j] * b[j]));
      by[j] = 0.0F;
    }
  };
  for (int i = 0; i < pattern_.grid.rows; ++i) {
    if (!isPushed(i, block)) continue;
    const std::size_t k = row(i) + first;
    move(k, warp_.x, weft_.x, push_.x, move_.x);
    move(k, warp_.y, weft_.y, push_.y, move_.y);
    move(k, warp_.z, weft_.z, push_.z, move_.z);
  }
  for (int i = pattern_.grid.rows; i < pattern_.grid.allRows(); ++i) {  // at which no rod or string ends
    if (!isPushed(i, block)) continue;
    for (std::size_t k = row(i) + first; k < row(i) + first + kColumns; ++k) {
      move_.x[k] = weight_[k] * push_.x[k];
      move_.y[k] = weight_[k] * push_.y[k];
      move_.z[k] = weight_[k] * push_.z[k];
      push_.x[k] = push_.y[k] = push_.z[k] = 0.0F;
    }
  }
}

// product_ = S pull_ for a block of rows, of all links; returns pull_ . product_.
CURTAIN_WIDE double NetSolver::schurProduct(int b) noexcept {
  const auto last = static_cast<std::size_t>(pattern_.grid.columns) - 1;
  const std::size_t first = row(b * kRows), count = kRows * stride_;
  const float *const diagonal = damped_.data(), *const off = weft_off_.data(), *const p = pull_.data();
  const float *const s = rods_.data(), *const s_below = s + stride_;
  const float *const above_left = above_left_.data(), *const above_right = above_right_.data();
  const float *const below_left = below_left_.data(), *const below_right = below_right_.data();
  float* const q = product_.data();
  // Link k ends at node k and begins where link k - 1 ends.
  const auto product = [=](std::size_t before, std::size_t k) {
    return diagonal[k] * p[k] + off[k] * p[k + 1] + off[before] * p[before] -
           (above_left[k] * s[k] + below_left[k] * s_below[k] + above_right[before] * s[before] +
            below_right[before] * s_below[before]);
  };
  // One loop over all rows: where there is no link all factors are zero.
#pragma omp simd
  for (std::size_t k = std::max<std::size_t>(first, 1); k < first + count; ++k) q[k] = product(k - 1, k);
  const int end = std::min((b + 1) * kRows, pattern_.grid.rows);
  for (int i = b * kRows; i < end; ++i) {
    if (pattern_.grid.closed) {  // the ring's link, which pull_ holds twice
      q[row(i)] = product(row(i) + last, row(i));
      q[row(i) + last + 1] = 0.0F;
    }
    if (rows_.any()) addPushes(i);
  }
  return dot(q + first, p + first, count);
}

// Adds the part of rows_ to a row of product_.
CURTAIN_INTO_WIDE void NetSolver::addPushes(int i) noexcept {
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  const std::size_t k = row(i);
  const float* const w = &weight_[k];
  const float *const fx = &weft_.x[k], *const fy = &weft_.y[k], *const fz = &weft_.z[k];
  const float *const px = &push_.x[k], *const py = &push_.y[k], *const pz = &push_.z[k];
  float* const q = &product_[k];
  const auto pushed = [=](std::size_t left, std::size_t j) {
    return fx[j] * (w[left] * px[left] - w[j] * px[j]) + fy[j] * (w[left] * py[left] - w[j] * py[j]) +
           fz[j] * (w[left] * pz[left] - w[j] * pz[j]);
  };
  if (pattern_.grid.closed) q[0] += pushed(columns - 1, 0);
  bool before = false;
  for (std::size_t first = 0; first < columns; first += kColumns) {
    const bool here = isPushed(i, static_cast<int>(first) / kColumns);
    if (here || before) {
      const std::size_t end = std::min(first + kColumns, columns);
#pragma omp simd
      for (std::size_t j = std::max<std::size_t>(first, 1); j < end; ++j) q[j] += pushed(j - 1, j);
    }
    before = here;
  }
}

// Number of links in a block of rows that would push, or have become too long.
CURTAIN_WIDE double NetSolver::countChanges(int b, Real goal) const noexcept {
  const std::size_t first = row(b * kRows), count = kRows * stride_;
  const float *const x = &solution_[first], *const r = &residual_[first];
  const float *const on = &mask_[first], *const least = &least_[first];
  float changes = 0.0F;
#pragma omp simd reduction(+ : changes)
  for (std::size_t k = 0; k < count; ++k) {
    const float leaves = x[k] < least[k] ? 1.0F : 0.0F;
    const float joins = r[k] > goal ? 1.0F : 0.0F;
    changes += on[k] > 0.0F ? leaves : joins;
  }
  return static_cast<double>(changes);
}

// Applies these changes; pull_ = what brings leaving links to multiplier zero. Returns how many leave.
CURTAIN_WIDE double NetSolver::changeSet(int b, Real goal) noexcept {
  const std::size_t first = row(b * kRows), count = kRows * stride_;
  const float *const x = &solution_[first], *const r = &residual_[first], *const least = &least_[first];
  float *const on = &mask_[first], *const p = &pull_[first];
  float leave = 0.0F;
#pragma omp simd reduction(+ : leave)
  for (std::size_t k = 0; k < count; ++k) {
    const float back = x[k] < least[k] ? least[k] - x[k] : 0.0F;
    const float stays = x[k] < least[k] ? 0.0F : 1.0F;
    const float joins = r[k] > goal ? 1.0F : 0.0F;
    leave += on[k] * (1.0F - stays);
    p[k] = on[k] * back;
    on[k] = on[k] > 0.0F ? stays : joins;
  }
  return static_cast<double>(leave);
}

// Makes a step along pull_; returns the largest residual left of the active links.
CURTAIN_WIDE double NetSolver::advance(int b, Real alpha) noexcept {
  const std::size_t first = row(b * kRows), count = kRows * stride_;
  float *const x = &solution_[first], *const r = &residual_[first];
  const float *const p = &pull_[first], *const q = &product_[first], *const on = &mask_[first];
  float largest = 0.0F;
#pragma omp simd reduction(max : largest)
  for (std::size_t k = 0; k < count; ++k) {
    x[k] += alpha * p[k];
    r[k] -= alpha * q[k];
    const float size = on[k] * std::abs(r[k]);
    largest = largest > size ? largest : size;
  }
  return static_cast<double>(largest);
}

// preconditioned_ = A_ff^-1 residual_ for a block of rows; returns their product.
CURTAIN_WIDE double NetSolver::precondition(int b) noexcept {
  const std::size_t first = row(b * kRows);
  const auto blocks = (static_cast<std::size_t>(pattern_.grid.columns) + kRows - 1) / kRows;
  const float* const r = &residual_[first];
  float* const z = &preconditioned_[first];
  float* const scratch = &interleaved_[first];
  const float *const inverse = &weft_inverse_[first], *const lower = &weft_lower_[first];
  float carry[kRows] = {};
  float lower_before[kRows] = {};
  for (std::size_t block = 0; block < blocks; ++block) {
    transpose(r + block * kRows, stride_, scratch + block * kSquare, kInterleave);
    for (std::size_t j = block * kSquare; j < (block + 1) * kSquare; j += kInterleave) {
#pragma omp simd
      for (std::size_t l = 0; l < kRows; ++l) {
        carry[l] = scratch[j + l] - lower_before[l] * carry[l];
        lower_before[l] = lower[j + l];
        scratch[j + l] = carry[l];
      }
    }
  }
  for (float& one : carry) one = 0.0F;
  for (std::size_t block = blocks; block-- > 0;) {
    for (std::size_t j = (block + 1) * kSquare; j > block * kSquare;) {
      j -= kInterleave;
#pragma omp simd
      for (std::size_t l = 0; l < kRows; ++l) {
        carry[l] = scratch[j + l] * inverse[j + l] - lower[j + l] * carry[l];
        scratch[j + l] = carry[l];
      }
    }
    transpose(scratch + block * kSquare, kInterleave, z + block * kRows, stride_);
  }
  return dot(z, r, kRows * stride_);
}

CURTAIN_WIDE void NetSolver::conjugate(int b, Real beta) noexcept {
  const std::size_t first = row(b * kRows), count = kRows * stride_;
  float* const p = &pull_[first];
  const float* const z = &preconditioned_[first];
#pragma omp simd
  for (std::size_t k = 0; k < count; ++k) p[k] = z[k] + beta * p[k];
}

}  // namespace curtain
