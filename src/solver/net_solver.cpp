// SPDX-License-Identifier: BSD-3-Clause
#include "solver/net_solver.h"

#include <algorithm>
#include <cmath>

#include "cloth/wide.h"

namespace curtain {
namespace {

constexpr int kColumns = 16;  // columns of a block, swept side by side along the warp
constexpr int kRows = 8;      // rows of a block, solved side by side along the weft
constexpr std::size_t kInterleave = kRows;
constexpr std::size_t kSquare = kRows * kInterleave;  // of kRows columns of a block; what is beyond the last column is 0

constexpr float kSmallestPivot = 1e-6F;  // of single precision's rounding, over (w_a + w_b)

CURTAIN_WIDE double largestOf(const Field& values) noexcept {
  const double* const value = values.data();
  const std::size_t count = values.size();
  double largest = 0.0;
#pragma omp simd reduction(max : largest)
  for (std::size_t n = 0; n < count; ++n) largest = largest > value[n] ? largest : value[n];
  return largest;
}

// Eight rows of eight numbers, from side by side to one after the other and back.
CURTAIN_INTO_WIDE void transpose(const float* from, std::size_t from_stride, float* to, std::size_t to_stride) noexcept {
#if defined(__GNUC__) && !defined(__clang__)
  typedef float Lanes __attribute__((vector_size(32), aligned(4)));
  typedef int Order __attribute__((vector_size(32)));
  Lanes a[kRows], b[kRows];
  for (std::size_t l = 0; l < kRows; ++l) a[l] = *reinterpret_cast<const Lanes*>(from + l * from_stride);
  for (std::size_t l = 0; l < kRows; l += 2) {
    b[l] = __builtin_shuffle(a[l], a[l + 1], Order{0, 8, 1, 9, 4, 12, 5, 13});
    b[l + 1] = __builtin_shuffle(a[l], a[l + 1], Order{2, 10, 3, 11, 6, 14, 7, 15});
  }
  for (std::size_t l = 0; l < kRows; l += 4) {
    for (std::size_t m = 0; m < 2; ++m) {
      a[l + 2 * m] = __builtin_shuffle(b[l + m], b[l + m + 2], Order{0, 1, 8, 9, 4, 5, 12, 13});
      a[l + 2 * m + 1] = __builtin_shuffle(b[l + m], b[l + m + 2], Order{2, 3, 10, 11, 6, 7, 14, 15});
    }
  }
  for (std::size_t l = 0; l < kRows / 2; ++l) {
    *reinterpret_cast<Lanes*>(to + l * to_stride) = __builtin_shuffle(a[l], a[l + 4], Order{0, 1, 2, 3, 8, 9, 10, 11});
    *reinterpret_cast<Lanes*>(to + (l + 4) * to_stride) = __builtin_shuffle(a[l], a[l + 4], Order{4, 5, 6, 7, 12, 13, 14, 15});
  }
#else
  for (std::size_t l = 0; l < kRows; ++l) {
    for (std::size_t m = 0; m < kRows; ++m) to[m * to_stride + l] = from[l * from_stride + m];
  }
#endif
}

// Partial sums of its own making: the same whatever width the registers have. count is a multiple of theirs.
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

NetSolver::NetSolver(const ClothPattern& pattern, const Workers& workers)
    : pattern_(pattern),
      workers_(workers),
      stride_((static_cast<std::size_t>((pattern.grid.columns + kColumns) / kColumns) | 1U) * kColumns),
      row_blocks_((pattern.grid.rows + kRows - 1) / kRows) {
  // Whole row blocks, and a row of zeros below the last one.
  const std::size_t size = (static_cast<std::size_t>(row_blocks_) * kRows + 1) * stride_;
  for (Values* values : {&weight_, &warp_.x, &warp_.y, &warp_.z, &weft_.x, &weft_.y, &weft_.z, &warp_inverse_,
                         &warp_lower_, &weft_diagonal_, &weft_off_, &weft_inverse_, &weft_lower_, &above_left_, &above_right_, &below_left_, &below_right_, &rods_, &move_.x, &move_.y, &move_.z, &mask_,
                         &residual_, &preconditioned_, &pull_, &product_, &solution_, &least_, &interleaved_, &push_.x, &push_.y, &push_.z}) {
    values->assign(size, 0.0F);
  }
  const auto reciprocal = [](const Field& rest) {
    Field out(rest.size());
    for (std::size_t n = 0; n < rest.size(); ++n) out[n] = 1.0 / rest[n];
    return out;
  };
  per_warp_rest_ = reciprocal(pattern.warp_rest);
  per_weft_rest_ = reciprocal(pattern.weft_rest);
  taut_.assign(static_cast<std::size_t>(row_blocks_), 0);
  partial_.assign(static_cast<std::size_t>(row_blocks_), 0.0);
}

void NetSolver::reset() noexcept {
  for (Values* values : {&weight_, &weft_.x, &weft_.y, &weft_.z, &above_left_, &above_right_, &below_left_, &below_right_, &rods_, &move_.x, &move_.y, &move_.z, &residual_, &preconditioned_, &pull_, &product_, &solution_,
                         &interleaved_, &push_.x, &push_.y, &push_.z}) {
    std::fill(values->begin(), values->end(), 0.0F);
  }
}

template <typename Block>
double NetSolver::sumOverRowBlocks(const Block& block) noexcept {
  workers_.run(row_blocks_, [&](int b) { partial_[static_cast<std::size_t>(b)] = taut_[static_cast<std::size_t>(b)] ? block(b) : 0.0; });
  double sum = 0.0;
  for (const double part : partial_) sum += part;
  return sum;
}

CURTAIN_WIDE void NetSolver::takeRow(const Field3& position, const Field& inverse_inertia, const ColumnSpan& span, int i) noexcept {
  const Grid& grid = pattern_.grid;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const std::size_t from = grid.row(i), to = row(i);
  const auto grid_stride = static_cast<std::size_t>(grid.stride);
  const double per_scale = 1.0 / inertia_scale_;
  const std::size_t first = span.first, end = span.end, first_link = span.firstLink(), end_link = span.endLink(columns);
  for (std::size_t j = first; j < end; ++j) weight_[to + j] = static_cast<float>(inverse_inertia[from + j] * per_scale);
  const auto difference = [&](const Field& values, Values& warp, Values& weft) {
    const double* const p = values.data() + from;
    const double* const per_warp = per_warp_rest_.data() + from;
    const double* const per_weft = per_weft_rest_.data() + from;
    float* const weft_out = weft.data() + to;
    if (i > 0) {
      const double* const above = p - grid_stride;
      float* const warp_out = warp.data() + to;
      for (std::size_t j = first; j < end; ++j) warp_out[j] = static_cast<float>((p[j] - above[j]) * per_warp[j]);
    }
    for (std::size_t j = first_link; j < end_link; ++j) weft_out[j] = static_cast<float>((p[j] - p[j - 1]) * per_weft[j]);
    if (grid.closed) weft_out[columns] = weft_out[0] = static_cast<float>((p[0] - p[columns - 1]) * per_weft[0]);
  };
  difference(position.x, warp_.x, weft_.x);
  difference(position.y, warp_.y, weft_.y);
  difference(position.z, warp_.z, weft_.z);
  // A_ff without regard to which links take part: the diagonal, and the entry towards the next link.
  const float* const w = &weight_[to];
  const float *const x = &weft_.x[to], *const y = &weft_.y[to], *const z = &weft_.z[to];
  float *const diagonal = &weft_diagonal_[to], *const off = &weft_off_[to];
  const auto square = [=](std::size_t j) { return x[j] * x[j] + y[j] * y[j] + z[j] * z[j]; };
  for (std::size_t j = first_link; j < end_link; ++j) {
    diagonal[j] = (w[j] + w[j - 1]) * (x[j] * x[j] + y[j] * y[j] + z[j] * z[j]);
    off[j] = -w[j] * (x[j] * x[j + 1] + y[j] * y[j + 1] + z[j] * z[j + 1]);
  }
  off[columns - 1] = grid.closed ? -w[columns - 1] * (x[columns - 1] * x[0] + y[columns - 1] * y[0] + z[columns - 1] * z[0]) : 0.0F;
  diagonal[0] = grid.closed ? (w[0] + w[columns - 1]) * square(0) : 0.0F;
  off[0] = grid.closed ? -w[0] * (x[0] * x[1] + y[0] * y[1] + z[0] * z[1]) : 0.0F;
}

void NetSolver::begin(const Field3& position, const Field& inverse_inertia, const ColumnSpan& span) noexcept {
  first_block_ = static_cast<int>(span.first) / kColumns;
  moving_blocks_ = (static_cast<int>(span.end) + kColumns - 1) / kColumns - first_block_;
  inertia_scale_ = largestOf(inverse_inertia);
  if (!(inertia_scale_ > 0.0)) inertia_scale_ = 1.0;
  workers_.run(row_blocks_, [&](int b) {
    const int end = std::min((b + 1) * kRows, pattern_.grid.rows);
    for (int i = b * kRows; i < end; ++i) takeRow(position, inverse_inertia, span, i);
  });
  workers_.run(moving_blocks_, [&](int b) {
    factorWarp(first_block_ + b);
    couple(first_block_ + b);
  });
}

// A_wf of a block of columns. Rod i ends below at its node, link j ends there on the right: these pull it along, the others push.
CURTAIN_WIDE void NetSolver::couple(int block) noexcept {
  const std::size_t first = static_cast<std::size_t>(block) * kColumns;
  for (int i = 0; i < pattern_.grid.rows; ++i) {
    const std::size_t k = row(i) + first;
    const float* const w = &weight_[k];
    const float *const nx = &warp_.x[k], *const ny = &warp_.y[k], *const nz = &warp_.z[k];
    const float *const bx = nx + stride_, *const by = ny + stride_, *const bz = nz + stride_;
    const float *const fx = &weft_.x[k], *const fy = &weft_.y[k], *const fz = &weft_.z[k];
    float *const above_left = &above_left_[k], *const above_right = &above_right_[k];
    float *const below_left = &below_left_[k], *const below_right = &below_right_[k];
#pragma omp simd
    for (std::size_t j = 0; j < kColumns; ++j) {
      const float gx = w[j] * fx[j], gy = w[j] * fy[j], gz = w[j] * fz[j];
      const float hx = w[j] * fx[j + 1], hy = w[j] * fy[j + 1], hz = w[j] * fz[j + 1];
      above_left[j] = nx[j] * gx + ny[j] * gy + nz[j] * gz;
      above_right[j] = -(nx[j] * hx + ny[j] * hy + nz[j] * hz);
      below_left[j] = -(bx[j] * gx + by[j] * gy + bz[j] * gz);
      below_right[j] = bx[j] * hx + by[j] * hy + bz[j] * hz;
    }
  }
}

// A rod whose ends are both held has no inertia to answer with: its inverse is 0 and it carries nothing.
CURTAIN_WIDE void NetSolver::factorWarp(int block) noexcept {
  const std::size_t first = static_cast<std::size_t>(block) * kColumns;
  float off_above[kColumns] = {};
  float lower_above[kColumns] = {};
  for (int i = 1; i < pattern_.grid.rows; ++i) {
    const std::size_t k = row(i) + first;
    const float* const w = &weight_[k];
    const float* const w_above = w - stride_;
    const float *const nx = &warp_.x[k], *const ny = &warp_.y[k], *const nz = &warp_.z[k];
    float* const inverse = &warp_inverse_[k];
    float* const lower = &warp_lower_[k];
#pragma omp simd
    for (std::size_t j = 0; j < kColumns; ++j) {
      const float both = w[j] + w_above[j];
      const float diagonal = both * (nx[j] * nx[j] + ny[j] * ny[j] + nz[j] * nz[j]);
      const float pivot = diagonal - off_above[j] * lower_above[j];
      const float smallest = kSmallestPivot * both;
      const float safe = pivot > smallest ? pivot : smallest;
      const float inverted = both > 0.0F ? 1.0F / (safe > 0.0F ? safe : 1.0F) : 0.0F;
      const float off = -w[j] * (nx[j] * nx[j + stride_] + ny[j] * ny[j + stride_] + nz[j] * nz[j + stride_]);
      inverse[j] = inverted;
      lower[j] = off * inverted;
      off_above[j] = off;
      lower_above[j] = off * inverted;
    }
  }
}

// Links are taken in the columns' order; that the last one of a ring shares a node with the first is left to the
// conjugate gradients.
CURTAIN_WIDE void NetSolver::factorWeft(int b) noexcept {
  float off_before[kRows] = {};
  float lower_before[kRows] = {};
  const std::size_t first = row(b * kRows);
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  for (std::size_t block = 0; block < columns; block += kRows) {
    float diagonals[kSquare], offs[kSquare], ons[kSquare], ons_after[kSquare];
    transpose(&weft_diagonal_[first + block], stride_, diagonals, kInterleave);
    transpose(&weft_off_[first + block], stride_, offs, kInterleave);
    transpose(&mask_[first + block], stride_, ons, kInterleave);
    transpose(&mask_[first + block + 1], stride_, ons_after, kInterleave);
    for (std::size_t j = 0; j < kSquare; j += kInterleave) {
      const float *const diagonal = diagonals + j, *const off = offs + j, *const on = ons + j, *const on_after = ons_after + j;
      float* const inverse = &weft_inverse_[first + block * kInterleave + j];
      float* const lower = &weft_lower_[first + block * kInterleave + j];
#pragma omp simd
      for (std::size_t r = 0; r < kRows; ++r) {
        const float pivot = diagonal[r] * (1.0F + damping_) - off_before[r] * lower_before[r];
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

// The right-hand side over its scale, and the vectors of the conjugate gradients at their start.
CURTAIN_WIDE void NetSolver::load(const Field& violation, const Field& active, const Field* multiplier, int b) noexcept {
  const Grid& grid = pattern_.grid;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const int end = std::min((b + 1) * kRows, grid.rows);
  const double per_scale = 1.0 / violation_scale_, per_multiplier = 1.0 / multiplierScale();
  float any = 0.0F;
  for (int i = b * kRows; i < end; ++i) {
    const double* const c = violation.data() + grid.row(i);
    const double* const a = active.data() + grid.row(i);
    const double* const per_rest = per_weft_rest_.data() + grid.row(i);
    float *const on = &mask_[row(i)], *const r = &residual_[row(i)], *const x = &solution_[row(i)], *const p = &pull_[row(i)];
#pragma omp simd reduction(+ : any)
    for (std::size_t j = 0; j < columns; ++j) {
      on[j] = static_cast<float>(a[j]);
      any += on[j];
      r[j] = static_cast<float>(c[j] * per_rest[j] * per_scale);
      x[j] = 0.0F;
      p[j] = 0.0F;
    }
    if (multiplier == nullptr) continue;
    const double* const s = multiplier->data() + grid.row(i);
    const double* const rest = pattern_.weft_rest.data() + grid.row(i);
    float* const least = &least_[row(i)];
#pragma omp simd
    for (std::size_t j = 0; j < columns; ++j) least[j] = static_cast<float>(-s[j] * rest[j] * per_multiplier);
  }
  taut_[static_cast<std::size_t>(b)] = any > 0.0F ? 1 : 0;
}

// What has left pulls no more, to the bit.
CURTAIN_WIDE void NetSolver::unload(int b, const Field* multiplier, Field& change) noexcept {
  const Grid& grid = pattern_.grid;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const int end = std::min((b + 1) * kRows, grid.rows);
  const double scale = multiplierScale();
  for (int i = b * kRows; i < end; ++i) {
    const double* const per_rest = per_weft_rest_.data() + grid.row(i);
    const float *const x = &solution_[row(i)], *const on = &mask_[row(i)];
    double* const out = change.data() + grid.row(i);
#pragma omp simd
    for (std::size_t j = 0; j < columns; ++j) out[j] = scale * static_cast<double>(x[j]) * per_rest[j];
    if (multiplier == nullptr) continue;
    const double* const s = multiplier->data() + grid.row(i);
    for (std::size_t j = 0; j < columns; ++j) out[j] = on[j] == 0.0F && x[j] != 0.0F ? -s[j] : out[j];
  }
}

// rods_ = what the rods of a block of columns answer to pull_ (and to the contacts' push_).
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
      s[j] = above_left[j] * p[j] + above_right[j] * p[j + 1] + below_left[j] * p_above[j] + below_right[j] * p_above[j + 1] -
             lower_above[j] * s_above[j];
    }
    if (!contacts_.any()) continue;
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
  // No rod ends at the top row: rods_ is 0 there, and stays so.
  for (int i = rows - 1; i > 0; --i) {
    const std::size_t k = row(i) + first;
    const float *const inverse = &warp_inverse_[k], *const lower = &warp_lower_[k];
    float* const s = &rods_[k];
    const float* const s_below = s + stride_;
#pragma omp simd
    for (std::size_t j = 0; j < kColumns; ++j) s[j] = s[j] * inverse[j] - lower[j] * s_below[j];
  }
}

// move_ = what the nodes of a block of columns do.
CURTAIN_WIDE void NetSolver::moveNodes(int block) noexcept {
  const std::size_t first = static_cast<std::size_t>(block) * kColumns;
  const auto move = [&](std::size_t k, const Values& warp, const Values& weft, const Values& push, Values& out) {
    const float *const w = &weight_[k], *const p = &pull_[k], *const s = &rods_[k], *const s_below = s + stride_;
    const float *const n = &warp[k], *const b = n + stride_, *const f = &weft[k], *const by = &push[k];
    float* const u = &out[k];
#pragma omp simd
    for (std::size_t j = 0; j < kColumns; ++j) {
      u[j] = w[j] * (p[j + 1] * f[j + 1] - p[j] * f[j] + by[j] + (s[j] * n[j] - s_below[j] * b[j]));
    }
  };
  for (int i = 0; i < pattern_.grid.rows; ++i) {
    const std::size_t k = row(i) + first;
    move(k, warp_.x, weft_.x, push_.x, move_.x);
    move(k, warp_.y, weft_.y, push_.y, move_.y);
    move(k, warp_.z, weft_.z, push_.z, move_.z);
  }
}

// product_ = S pull_ of a block of rows, of links that take part and of those that may; returns pull_ . product_.
CURTAIN_WIDE double NetSolver::schurProduct(int b) noexcept {
  const auto last = static_cast<std::size_t>(pattern_.grid.columns) - 1;
  const std::size_t first = row(b * kRows), count = kRows * stride_;
  const float *const diagonal = weft_diagonal_.data(), *const off = weft_off_.data(), *const p = pull_.data();
  const float *const s = rods_.data(), *const s_below = s + stride_;
  const float *const above_left = above_left_.data(), *const above_right = above_right_.data();
  const float *const below_left = below_left_.data(), *const below_right = below_right_.data();
  const float damped = 1.0F + damping_;
  float* const q = product_.data();
  // Link k ends at node k, and begins where the link before it ends.
  const auto product = [=](std::size_t before, std::size_t k) {
    return damped * diagonal[k] * p[k] + off[k] * p[k + 1] + off[before] * p[before] -
           (above_left[k] * s[k] + below_left[k] * s_below[k] + above_right[before] * s[before] + below_right[before] * s_below[before]);
  };
  // All rows in one: where there is no link there are zeros.
#pragma omp simd
  for (std::size_t k = std::max<std::size_t>(first, 1); k < first + count; ++k) q[k] = product(k - 1, k);
  const int end = std::min((b + 1) * kRows, pattern_.grid.rows);
  for (int i = b * kRows; i < end; ++i) {
    if (pattern_.grid.closed) {  // the ring's link, which p holds twice
      q[row(i)] = product(row(i) + last, row(i));
      q[row(i) + last + 1] = 0.0F;
    }
    if (contacts_.any()) addPushes(i);
  }
  return dot(q + first, p + first, count);
}

// The contacts' part of a row of product_.
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
#pragma omp simd
  for (std::size_t j = 1; j < columns; ++j) q[j] += pushed(j - 1, j);
}

// Links of a block of rows that would push, or have become too long.
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

// They leave, or join; pull_ = what takes those that leave back to where they do nothing. Returns how many leave.
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

// A step along pull_; returns the largest residual that is left of the links that take part.
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

// preconditioned_ = A_ff^-1 residual_ of a block of rows, side by side; returns their product.
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

// The ring's link stands on both ends of its row.
void NetSolver::closeRows(Values& links) noexcept {
  if (!pattern_.grid.closed) return;
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  for (int i = 0; i < pattern_.grid.rows; ++i) links[row(i) + columns] = links[row(i)];
}

// product_ = S pull_, and the contacts' part of it; returns pull_ . product_.
double NetSolver::applySchur() noexcept {
  closeRows(pull_);
  workers_.run(moving_blocks_, [&](int b) { answerOfRods(first_block_ + b); });
  const double sum = sumOverRowBlocks([&](int b) { return schurProduct(b); });
  if (!contacts_.any()) return sum;
  workers_.run(moving_blocks_, [&](int b) { moveNodes(first_block_ + b); });
  return sum + contacts_.product({move_.x.data(), move_.y.data(), move_.z.data()}, {push_.x.data(), push_.y.data(), push_.z.data()});
}

double NetSolver::step(Real alpha) noexcept {
  sumOverRowBlocks([&](int b) { return advance(b, alpha); });
  return std::max(*std::max_element(partial_.begin(), partial_.end()), contacts_.advance(alpha));
}

// Lets strings leave and join; false: none does.
bool NetSolver::changeStrings(Real goal) noexcept {
  if (sumOverRowBlocks([&](int b) { return countChanges(b, goal); }) == 0.0) return false;
  const double leave = sumOverRowBlocks([&](int b) {
    const bool changes = partial_[static_cast<std::size_t>(b)] > 0.0;
    const double leave_here = changeSet(b, goal);
    if (changes) factorWeft(b);
    return leave_here;
  });
  if (leave == 0.0) return true;
  applySchur();
  step(1.0F);
  return true;
}

// Numbers that are not finite end the iteration before they reach the vectors. Among contacts strings stay what they were: rows that
// are damped so much find no set.
NetSolver::Outcome NetSolver::solve(const Field& violation, const Field& active, const ContactValues& contacts, const Aim& aim,
                                    Field& change) noexcept {
  Outcome outcome;
  damping_ = static_cast<float>(aim.damping);
  violation_scale_ = aim.largest;
  contacts_.load({pattern_.grid, stride_, weight_.data(), inertia_scale_, violation_scale_, damping_}, contacts);
  workers_.run(row_blocks_, [&](int b) { load(violation, active, aim.multiplier, b); });
  const bool changes = aim.multiplier != nullptr && !contacts_.any();
  sumOverRowBlocks([&](int b) {
    factorWeft(b);
    return 0.0;
  });
  double aligned = 0.0;
  bool anew = true;
  outcome.reduction = 1.0;
  while (true) {
    const double next = sumOverRowBlocks([&](int b) { return precondition(b); }) + contacts_.aligned();
    const float beta = anew ? 0.0F : static_cast<float>(next / aligned);
    aligned = next;
    anew = false;
    if (outcome.iterations >= aim.most_iterations || !(aligned > 0.0)) break;
    ++outcome.iterations;
    sumOverRowBlocks([&](int b) {
      conjugate(b, beta);
      return 0.0;
    });
    contacts_.turn(beta, {push_.x.data(), push_.y.data(), push_.z.data()});
    const double curvature = applySchur();
    const auto alpha = static_cast<float>(aligned / curvature);
    if (!(curvature > 0.0) || !std::isfinite(alpha)) break;
    outcome.reduction = step(alpha);
    if (outcome.reduction > aim.reduction) continue;
    anew = changes && changeStrings(static_cast<float>(aim.reduction));
    if (!anew) break;
  }
  workers_.run(row_blocks_, [&](int b) { unload(b, aim.multiplier, change); });
  return outcome;
}

}  // namespace curtain
