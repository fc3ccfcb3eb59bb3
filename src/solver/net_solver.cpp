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

constexpr float kSmallestPivot = 1e-6F;  // of single precision's rounding, over (w_a + w_b)

}  // namespace

NetSolver::NetSolver(const ClothPattern& pattern, const Workers& workers)
    : pattern_(pattern),
      workers_(workers),
      stride_((static_cast<std::size_t>((pattern.grid.columns + kColumns) / kColumns) | 1U) * kColumns),
      row_blocks_((pattern.grid.rows + kRows - 1) / kRows) {
  // Whole row blocks, and a row of zeros below the last one.
  const std::size_t size = (static_cast<std::size_t>(row_blocks_) * kRows + 1) * stride_;
  for (Values* values : {&weight_, &warp_.x, &warp_.y, &warp_.z, &weft_.x, &weft_.y, &weft_.z, &warp_inverse_,
                         &warp_lower_, &weft_diagonal_, &weft_off_, &weft_inverse_, &weft_lower_, &rods_, &move_.x, &move_.y, &move_.z, &mask_,
                         &residual_, &preconditioned_, &pull_, &product_, &solution_, &interleaved_, &push_.x, &push_.y, &push_.z}) {
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
  for (Values* values : {&weight_, &weft_.x, &weft_.y, &weft_.z, &rods_, &move_.x, &move_.y, &move_.z, &residual_, &preconditioned_, &pull_, &product_, &solution_,
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
  off[columns - 1] = 0.0F;
  diagonal[0] = grid.closed ? (w[0] + w[columns - 1]) * square(0) : 0.0F;
  off[0] = grid.closed ? -w[0] * (x[0] * x[1] + y[0] * y[1] + z[0] * z[1]) : 0.0F;
}

void NetSolver::begin(const Field3& position, const Field& inverse_inertia, const ColumnSpan& span) noexcept {
  first_block_ = static_cast<int>(span.first) / kColumns;
  moving_blocks_ = (static_cast<int>(span.end) + kColumns - 1) / kColumns - first_block_;
  inertia_scale_ = 0.0;
  for (const double w : inverse_inertia) inertia_scale_ = std::max(inertia_scale_, w);
  if (!(inertia_scale_ > 0.0)) inertia_scale_ = 1.0;
  workers_.run(row_blocks_, [&](int b) {
    const int end = std::min((b + 1) * kRows, pattern_.grid.rows);
    for (int i = b * kRows; i < end; ++i) takeRow(position, inverse_inertia, span, i);
  });
  workers_.run(moving_blocks_, [&](int b) { factorWarp(first_block_ + b); });
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
  for (std::size_t j = 0; j < columns; ++j) {
    float diagonal[kRows], off[kRows], on[kRows];
    for (std::size_t r = 0; r < kRows; ++r) {
      const std::size_t k = first + r * stride_ + j;
      diagonal[r] = weft_diagonal_[k];
      off[r] = weft_off_[k] * mask_[k + 1];
      on[r] = mask_[k];
    }
    float* const inverse = &weft_inverse_[first + j * kInterleave];
    float* const lower = &weft_lower_[first + j * kInterleave];
#pragma omp simd
    for (std::size_t r = 0; r < kRows; ++r) {
      const float pivot = diagonal[r] * (1.0F + damping_) - off_before[r] * lower_before[r];
      const float smallest = kSmallestPivot * diagonal[r];
      const float safe = pivot > smallest ? pivot : smallest;
      const float inverted = on[r] > 0.0F ? 1.0F / (safe > 0.0F ? safe : 1.0F) : 0.0F;
      const float coupling = on[r] * off[r];
      inverse[r] = inverted;
      lower[r] = coupling * inverted;
      off_before[r] = coupling;
      lower_before[r] = coupling * inverted;
    }
  }
}

// The right-hand side over its scale, and the vectors of the conjugate gradients at their start.
CURTAIN_WIDE void NetSolver::load(const Field& violation, const Field& active, int b) noexcept {
  const Grid& grid = pattern_.grid;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const int end = std::min((b + 1) * kRows, grid.rows);
  const double per_scale = 1.0 / violation_scale_;
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
      r[j] = static_cast<float>(a[j] * c[j] * per_rest[j] * per_scale);
      x[j] = 0.0F;
      p[j] = 0.0F;
    }
  }
  taut_[static_cast<std::size_t>(b)] = any > 0.0F ? 1 : 0;
}

CURTAIN_WIDE void NetSolver::unload(int b, double scale, Field& change) noexcept {
  const Grid& grid = pattern_.grid;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const int end = std::min((b + 1) * kRows, grid.rows);
  for (int i = b * kRows; i < end; ++i) {
    const double* const per_rest = per_weft_rest_.data() + grid.row(i);
    const float* const x = &solution_[row(i)];
    double* const out = change.data() + grid.row(i);
#pragma omp simd
    for (std::size_t j = 0; j < columns; ++j) out[j] = scale * static_cast<double>(x[j]) * per_rest[j];
  }
}

// move_ = what the nodes of a block of columns do when the strings pull and the rods answer:
// down with the strings' (and the contacts') part and L's forward substitution, up with the backward one and the rods' part.
CURTAIN_WIDE void NetSolver::answerOfRods(int block) noexcept {
  const std::size_t first = static_cast<std::size_t>(block) * kColumns;
  const int rows = pattern_.grid.rows;
  for (int i = 0; i < rows; ++i) {
    const std::size_t k = row(i) + first;
    const float *const w = &weight_[k], *const p = &pull_[k];
    const float *const fx = &weft_.x[k], *const fy = &weft_.y[k], *const fz = &weft_.z[k];
    float *const ux = &move_.x[k], *const uy = &move_.y[k], *const uz = &move_.z[k];
#pragma omp simd
    for (std::size_t j = 0; j < kColumns; ++j) {
      ux[j] = w[j] * (p[j + 1] * fx[j + 1] - p[j] * fx[j]);
      uy[j] = w[j] * (p[j + 1] * fy[j + 1] - p[j] * fy[j]);
      uz[j] = w[j] * (p[j + 1] * fz[j + 1] - p[j] * fz[j]);
    }
    if (contacts_.any()) {
      const float *const px = &push_.x[k], *const py = &push_.y[k], *const pz = &push_.z[k];
#pragma omp simd
      for (std::size_t j = 0; j < kColumns; ++j) {
        ux[j] += w[j] * px[j];
        uy[j] += w[j] * py[j];
        uz[j] += w[j] * pz[j];
      }
    }
    if (i == 0) continue;
    const float *const nx = &warp_.x[k], *const ny = &warp_.y[k], *const nz = &warp_.z[k];
    const float *const ax = ux - stride_, *const ay = uy - stride_, *const az = uz - stride_;
    const float* const lower_above = &warp_lower_[k - stride_];
    float* const s = &rods_[k];
    const float* const s_above = s - stride_;
#pragma omp simd
    for (std::size_t j = 0; j < kColumns; ++j) {
      s[j] = nx[j] * (ux[j] - ax[j]) + ny[j] * (uy[j] - ay[j]) + nz[j] * (uz[j] - az[j]) - lower_above[j] * s_above[j];
    }
  }
  // No rod ends at the top row; after numbers that were not finite it must not remember them.
  std::fill_n(rods_.begin() + static_cast<std::ptrdiff_t>(first), kColumns, 0.0F);
  for (int i = rows - 1; i >= 0; --i) {
    const std::size_t k = row(i) + first;
    const float* const w = &weight_[k];
    const float *const nx = &warp_.x[k], *const ny = &warp_.y[k], *const nz = &warp_.z[k];
    const float *const bx = nx + stride_, *const by = ny + stride_, *const bz = nz + stride_;
    float *const ux = &move_.x[k], *const uy = &move_.y[k], *const uz = &move_.z[k];
    const float *const inverse = &warp_inverse_[k], *const lower = &warp_lower_[k];
    float* const s = &rods_[k];
    const float* const s_below = s + stride_;
#pragma omp simd
    for (std::size_t j = 0; j < kColumns; ++j) {
      const float below = s_below[j];
      const float here = s[j] * inverse[j] - lower[j] * below;
      s[j] = here;
      ux[j] -= w[j] * (here * nx[j] - below * bx[j]);
      uy[j] -= w[j] * (here * ny[j] - below * by[j]);
      uz[j] -= w[j] * (here * nz[j] - below * bz[j]);
    }
  }
}

// product_ = S pull_ of a block of rows, from move_; returns pull_ . product_.
CURTAIN_WIDE double NetSolver::schurProduct(int b) noexcept {
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  constexpr std::size_t kPartials = 8;  // divides the stride
  float partials[kPartials] = {};
  const int end = std::min((b + 1) * kRows, pattern_.grid.rows);
  for (int i = b * kRows; i < end; ++i) {
    const std::size_t k = row(i);
    const float *const fx = &weft_.x[k], *const fy = &weft_.y[k], *const fz = &weft_.z[k];
    const float *const ux = &move_.x[k], *const uy = &move_.y[k], *const uz = &move_.z[k];
    const float *const diagonal = &weft_diagonal_[k], *const p = &pull_[k], *const on = &mask_[k];
    float* const q = &product_[k];
    if (pattern_.grid.closed) {
      const std::size_t last = columns - 1;
      q[0] = on[0] * (fx[0] * (ux[last] - ux[0]) + fy[0] * (uy[last] - uy[0]) + fz[0] * (uz[last] - uz[0]) +
                      damping_ * diagonal[0] * p[0]);
    }
#pragma omp simd
    for (std::size_t j = 1; j < columns; ++j) {
      const float value = on[j] * (fx[j] * (ux[j - 1] - ux[j]) + fy[j] * (uy[j - 1] - uy[j]) +
                                   fz[j] * (uz[j - 1] - uz[j]) + damping_ * diagonal[j] * p[j]);
      q[j] = value;
    }
    // Partial sums of its own making: the same whatever width the registers have.
    for (std::size_t j = 0; j < stride_; j += kPartials) {
#pragma omp simd
      for (std::size_t l = 0; l < kPartials; ++l) partials[l] += q[j + l] * p[j + l];
    }
  }
  double sum = 0.0;
  for (const float part : partials) sum += static_cast<double>(part);
  return sum;
}

// A step along pull_; returns the largest residual that is left.
CURTAIN_WIDE double NetSolver::advance(int b, Real alpha) noexcept {
  const std::size_t first = row(b * kRows), count = kRows * stride_;
  float *const x = &solution_[first], *const r = &residual_[first];
  const float *const p = &pull_[first], *const q = &product_[first];
  float largest = 0.0F;
#pragma omp simd reduction(max : largest)
  for (std::size_t k = 0; k < count; ++k) {
    x[k] += alpha * p[k];
    r[k] -= alpha * q[k];
    const float size = std::abs(r[k]);
    largest = largest > size ? largest : size;
  }
  return static_cast<double>(largest);
}

// preconditioned_ = A_ff^-1 residual_ of a block of rows, side by side; returns their product.
CURTAIN_WIDE double NetSolver::precondition(int b) noexcept {
  const std::size_t first = row(b * kRows);
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  const float* const r = &residual_[first];
  float* const z = &preconditioned_[first];
  float* const scratch = &interleaved_[first];
  const float *const inverse = &weft_inverse_[first], *const lower = &weft_lower_[first];
  float carry[kRows] = {};
  for (std::size_t j = 0; j < columns; ++j) {
    float* const out = scratch + j * kInterleave;
    for (std::size_t l = 0; l < kRows; ++l) out[l] = r[l * stride_ + j];
    const float* const lower_before = lower + (j > 0 ? j - 1 : 0) * kInterleave;
#pragma omp simd
    for (std::size_t l = 0; l < kRows; ++l) {
      carry[l] = out[l] - lower_before[l] * carry[l];
      out[l] = carry[l];
    }
  }
  for (std::size_t l = 0; l < kRows; ++l) carry[l] = 0.0F;
  float sums[kRows] = {};
  for (std::size_t j = columns; j-- > 0;) {
    const float* const in = scratch + j * kInterleave;
    const float* const inv = inverse + j * kInterleave;
    const float* const low = lower + j * kInterleave;
#pragma omp simd
    for (std::size_t l = 0; l < kRows; ++l) carry[l] = in[l] * inv[l] - low[l] * carry[l];
    for (std::size_t l = 0; l < kRows; ++l) {
      z[l * stride_ + j] = carry[l];
      sums[l] += carry[l] * r[l * stride_ + j];
    }
  }
  double sum = 0.0;
  for (const float part : sums) sum += static_cast<double>(part);
  return sum;
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

// Numbers that are not finite end the iteration before they reach the vectors.
NetSolver::Outcome NetSolver::solve(const Field& violation, const Field& active, const ContactValues& contacts, const Aim& aim,
                                    Field& change) noexcept {
  Outcome outcome;
  damping_ = static_cast<float>(aim.damping);
  violation_scale_ = aim.largest;
  contacts_.load({pattern_.grid, stride_, weight_.data(), inertia_scale_, violation_scale_, damping_}, contacts);
  workers_.run(row_blocks_, [&](int b) { load(violation, active, b); });
  double aligned = sumOverRowBlocks([&](int b) {
    factorWeft(b);
    const double sum = precondition(b);
    conjugate(b, 0.0F);
    return sum;
  });
  aligned += contacts_.aligned();
  const NetNodes push{push_.x.data(), push_.y.data(), push_.z.data()};
  const NetNodes move{move_.x.data(), move_.y.data(), move_.z.data()};
  outcome.reduction = 1.0;
  float beta = 0.0F;
  while (outcome.iterations < aim.most_iterations && aligned > 0.0) {
    ++outcome.iterations;
    closeRows(pull_);
    contacts_.turn(beta, push);
    workers_.run(moving_blocks_, [&](int b) { answerOfRods(first_block_ + b); });
    const double touching = contacts_.product(move, push);
    const double curvature = sumOverRowBlocks([&](int b) { return schurProduct(b); }) + touching;
    const auto alpha = static_cast<float>(aligned / curvature);
    if (!(curvature > 0.0) || !std::isfinite(alpha)) break;
    workers_.run(row_blocks_, [&](int b) {
      partial_[static_cast<std::size_t>(b)] = taut_[static_cast<std::size_t>(b)] ? advance(b, alpha) : 0.0;
    });
    const double left = contacts_.advance(alpha);
    outcome.reduction = std::max(*std::max_element(partial_.begin(), partial_.end()), left);
    if (outcome.reduction <= aim.reduction) break;
    const double next = sumOverRowBlocks([&](int b) { return precondition(b); }) + contacts_.aligned();
    beta = static_cast<float>(next / aligned);
    aligned = next;
    workers_.run(row_blocks_, [&](int b) {
      if (taut_[static_cast<std::size_t>(b)]) conjugate(b, beta);
    });
  }
  workers_.run(row_blocks_, [&](int b) { unload(b, multiplierScale(), change); });
  return outcome;
}

}  // namespace curtain
