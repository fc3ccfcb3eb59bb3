// SPDX-License-Identifier: BSD-3-Clause
#include "step/net_solver.h"

#include <algorithm>
#include <cmath>

#include "cloth/wide.h"

namespace curtain {
namespace {

// The values are not negative.
CURTAIN_WIDE double largestOf(const Field& values) noexcept {
  const double* const value = values.data();
  const std::size_t count = values.size();
  double largest = 0.0;
#pragma omp simd reduction(max : largest)
  for (std::size_t n = 0; n < count; ++n) largest = largest > value[n] ? largest : value[n];
  return largest;
}

}  // namespace

NetSolver::NetSolver(const ClothPattern& pattern, const Workers& workers)
    : pattern_(pattern),
      workers_(workers),
      stride_((static_cast<std::size_t>((pattern.grid.columns + kColumns) / kColumns) | 1U) * kColumns),
      row_blocks_((pattern.grid.rows + kRows - 1) / kRows),
      column_blocks_((pattern.grid.columns + kColumns - 1) / kColumns),
      rows_(workers) {
  // Whole row blocks, and a row of zeros below the last one; of the ends' rows nothing but nodal values is used.
  const std::size_t size = (static_cast<std::size_t>(row_blocks_ * kRows + 1 + pattern.grid.end_rows)) * stride_;
  for (Values* values : allVectors()) values->assign(size, 0.0F);
  const auto reciprocal = [](const Field& rest) {
    Field out(rest.size());
    for (std::size_t n = 0; n < rest.size(); ++n) out[n] = 1.0 / rest[n];
    return out;
  };
  per_warp_rest_ = reciprocal(pattern.warp_rest);
  per_weft_rest_ = reciprocal(pattern.weft_rest);
  pushed_.assign(size / kColumns, 0);
  taut_.assign(static_cast<std::size_t>(row_blocks_), 0);
  partial_.assign(static_cast<std::size_t>(row_blocks_), 0.0);
  changed_ = partial_;
}

std::array<NetSolver::Values*, 33> NetSolver::allVectors() noexcept {
  return {&weight_,       &warp_.x,     &warp_.y,         &warp_.z,   &weft_.x,       &weft_.y,     &weft_.z,
          &warp_inverse_, &warp_lower_, &weft_diagonal_,  &weft_off_, &weft_inverse_, &weft_lower_, &above_left_,
          &above_right_,  &below_left_, &below_right_,    &rods_,     &move_.x,       &move_.y,     &move_.z,
          &mask_,         &residual_,   &preconditioned_, &pull_,     &product_,      &solution_,   &least_,
          &interleaved_,  &push_.x,     &push_.y,         &push_.z,   &damped_};
}

void NetSolver::reset() noexcept {
  for (Values* values : allVectors()) std::fill(values->begin(), values->end(), 0.0F);
}

template <typename Block>
double NetSolver::sumOverRowBlocks(const Block& block) noexcept {
  workers_.run(row_blocks_, [&](int b) {
    partial_[static_cast<std::size_t>(b)] = taut_[static_cast<std::size_t>(b)] ? block(b) : 0.0;
  });
  double sum = 0.0;
  for (const double part : partial_) sum += part;
  return sum;
}

CURTAIN_WIDE void NetSolver::loadRow(const Field3& position, const Field& inverse_inertia, int i) noexcept {
  const Grid& grid = pattern_.grid;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const std::size_t from = grid.row(i), to = row(i);
  const auto grid_stride = static_cast<std::size_t>(grid.stride);
  const double per_scale = 1.0 / inertia_scale_;
  for (std::size_t j = 0; j < columns; ++j) weight_[to + j] = static_cast<float>(inverse_inertia[from + j] * per_scale);
  const auto difference = [&](const Field& values, Values& warp, Values& weft) {
    const double* const p = values.data() + from;
    const double* const per_warp = per_warp_rest_.data() + from;
    const double* const per_weft = per_weft_rest_.data() + from;
    float* const weft_out = weft.data() + to;
    if (i > 0) {
      const double* const above = p - grid_stride;
      float* const warp_out = warp.data() + to;
      for (std::size_t j = 0; j < columns; ++j) warp_out[j] = static_cast<float>((p[j] - above[j]) * per_warp[j]);
    }
    for (std::size_t j = 1; j < columns; ++j) weft_out[j] = static_cast<float>((p[j] - p[j - 1]) * per_weft[j]);
    if (grid.closed) weft_out[columns] = weft_out[0] = static_cast<float>((p[0] - p[columns - 1]) * per_weft[0]);
  };
  difference(position.x, warp_.x, weft_.x);
  difference(position.y, warp_.y, weft_.y);
  difference(position.z, warp_.z, weft_.z);
  // A_ff as if all links took part: the diagonal, and the entry towards the next link.
  const float* const w = &weight_[to];
  const float *const x = &weft_.x[to], *const y = &weft_.y[to], *const z = &weft_.z[to];
  float *const diagonal = &weft_diagonal_[to], *const off = &weft_off_[to];
  const auto square = [=](std::size_t j) { return x[j] * x[j] + y[j] * y[j] + z[j] * z[j]; };
  for (std::size_t j = 1; j < columns; ++j) {
    diagonal[j] = (w[j] + w[j - 1]) * (x[j] * x[j] + y[j] * y[j] + z[j] * z[j]);
    off[j] = -w[j] * (x[j] * x[j + 1] + y[j] * y[j + 1] + z[j] * z[j + 1]);
  }
  off[columns - 1] =
      grid.closed ? -w[columns - 1] * (x[columns - 1] * x[0] + y[columns - 1] * y[0] + z[columns - 1] * z[0]) : 0.0F;
  diagonal[0] = grid.closed ? (w[0] + w[columns - 1]) * square(0) : 0.0F;
  off[0] = grid.closed ? -w[0] * (x[0] * x[1] + y[0] * y[1] + z[0] * z[1]) : 0.0F;
}

void NetSolver::begin(const Field3& position, const Field& inverse_inertia, const GuidedNodes* guided) noexcept {
  guided_ = guided;
  inertia_scale_ = largestOf(inverse_inertia);
  if (!(inertia_scale_ > 0.0)) inertia_scale_ = 1.0;
  workers_.run(row_blocks_, [&](int b) {
    const int end = std::min((b + 1) * kRows, pattern_.grid.rows);
    for (int i = b * kRows; i < end; ++i) loadRow(position, inverse_inertia, i);
  });
  const Grid& grid = pattern_.grid;
  for (int i = grid.rows; i < grid.allRows(); ++i) {  // at which no rod or string ends
    for (std::size_t j = 0; j < static_cast<std::size_t>(grid.columns); ++j)
      weight_[row(i) + j] = static_cast<float>(inverse_inertia[grid.row(i) + j] / inertia_scale_);
  }
  if (guided_ != nullptr) loadGuided();
  workers_.run(column_blocks_, [&](int b) {
    factorWarp(b);
    couple(b);
  });
}

// A_wf of a block of columns. A node is the lower end of its rod and the right end of its link: those two pull it back,
// the rod below and the link on the right pull it on.
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
  if (guided_ != nullptr) coupleGuided(block);
}

// A rod between two fixed nodes has no inertia: its inverse is 0 and it takes no part.
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
    if (guided_ != nullptr && (guided_->inRow(i - 1) || guided_->inRow(i)))
      factorGuided(block, i, off_above, lower_above);
  }
}

// Scales the right-hand side and initialises the conjugate gradients.
CURTAIN_WIDE void NetSolver::load(const Field& violation, const Field& active, const Aim& aim, int b) noexcept {
  const Grid& grid = pattern_.grid;
  const auto columns = static_cast<std::size_t>(grid.columns);
  const int end = std::min((b + 1) * kRows, grid.rows);
  const double per_scale = 1.0 / violation_scale_, per_multiplier = 1.0 / multiplierScale();
  float any = 0.0F;
  for (int i = b * kRows; i < end; ++i) {
    const double* const c = violation.data() + grid.row(i);
    const double* const a = active.data() + grid.row(i);
    const double* const per_rest = per_weft_rest_.data() + grid.row(i);
    float *const on = &mask_[row(i)], *const r = &residual_[row(i)], *const x = &solution_[row(i)],
                 *const p = &pull_[row(i)];
#pragma omp simd reduction(+ : any)
    for (std::size_t j = 0; j < columns; ++j) {
      on[j] = static_cast<float>(a[j]);
      any += on[j];
      r[j] = static_cast<float>(c[j] * per_rest[j] * per_scale);
      x[j] = 0.0F;
      p[j] = 0.0F;
    }
    const float* const diagonal = &weft_diagonal_[row(i)];
    float* const damped = &damped_[row(i)];
    for (std::size_t j = 0; j < columns; ++j) damped[j] = diagonal[j] * (1.0F + damping_);
    if (aim.compliance != nullptr) {
      const double* const give = aim.compliance->data() + grid.row(i);
      for (std::size_t j = 0; j < columns; ++j) damped[j] += diagonal[j] * static_cast<float>(give[j]);
    }
    if (aim.multiplier == nullptr) continue;
    const double* const s = aim.multiplier->data() + grid.row(i);
    const double* const rest = pattern_.weft_rest.data() + grid.row(i);
    float* const least = &least_[row(i)];
#pragma omp simd
    for (std::size_t j = 0; j < columns; ++j) least[j] = static_cast<float>(-s[j] * rest[j] * per_multiplier);
  }
  taut_[static_cast<std::size_t>(b)] = any > 0.0F ? 1 : 0;
}

// Converts the solution into changes of multipliers. Strings that have left the active set end at exactly zero.
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

// The link that closes a ring is stored at both ends of its row.
void NetSolver::closeRows(Values& links) noexcept {
  if (!pattern_.grid.closed) return;
  const auto columns = static_cast<std::size_t>(pattern_.grid.columns);
  for (int i = 0; i < pattern_.grid.rows; ++i) links[row(i) + columns] = links[row(i)];
}

// product_ = S pull_, and the part of rows_; returns pull_ . product_.
double NetSolver::applySchur() noexcept {
  closeRows(pull_);
  workers_.run(column_blocks_, [&](int b) { answerOfRods(b); });
  const double sum = sumOverRowBlocks([&](int b) { return schurProduct(b); });
  if (!rows_.any()) return sum;
  workers_.run(column_blocks_, [&](int b) {
    moveNodes(b);
    if (guided_ != nullptr) keepFreedom(move_, b * kColumns, (b + 1) * kColumns);
  });
  return sum + rows_.product({move_.x.data(), move_.y.data(), move_.z.data()});
}

double NetSolver::step(Real alpha) noexcept {
  sumOverRowBlocks([&](int b) { return advance(b, alpha); });
  return std::max(*std::max_element(partial_.begin(), partial_.end()), rows_.advance(alpha));
}

// Updates the active set of strings; false: no change.
bool NetSolver::changeStrings(Real goal) noexcept {
  const double of_strings = sumOverRowBlocks([&](int b) { return countChanges(b, goal); });
  if (of_strings == 0.0 && rows_.countChanges(goal) == 0) return false;
  changed_ = partial_;
  double leave = sumOverRowBlocks([&](int b) { return changeSet(b, goal); });
  leave += rows_.changeSet(goal, pushes());
  // In a second loop: factorWeft() reads whole vectors, with the first link of the block below.
  sumOverRowBlocks([&](int b) {
    if (changed_[static_cast<std::size_t>(b)] > 0.0) factorWeft(b);
    return 0.0;
  });
  if (leave == 0.0) return true;
  if (guided_ != nullptr) keepFreedom(push_, 0, pattern_.grid.columns);
  applySchur();
  step(1.0F);
  return true;
}

// A row's diagonal is what the rods leave of its nodes' mobility: that of the Schur complement itself. Where a row
// continues a taut column this is the other end's mobility alone, a small part of the node's. With a least damping it
// is the nodes' own mobility: damped by a share of what the rods leave, fewer drapes come to rest.
void NetSolver::loadRows(const Rows& rows, bool set_may_change) noexcept {
  const NetRows::Frame frame{static_cast<std::uint32_t>(pattern_.grid.stride), static_cast<std::uint32_t>(stride_),
                             inertia_scale_, violation_scale_, damping_};
  const std::size_t ends = row(pattern_.grid.rows);
  rows_.load(frame, rows, set_may_change, [&](const Row& one, const std::array<std::uint32_t, 4>& node) {
    const auto square = static_cast<float>(one.direction.squaredNorm());
    float sum = 0.0F;
    for (std::size_t k = 0; k < static_cast<std::size_t>(one.nodes); ++k) {
      const auto weight = static_cast<float>(one.weight[k]);
      const bool held = one.min_damping == 0.0 && node[k] < ends;
      const float mobility = held ? static_cast<float>(mobilityOf(node[k], one.direction)) : weight_[node[k]] * square;
      sum += weight * weight * mobility;
    }
    return sum;
  });
}

// direction^T (W - W N^T A_ww^-1 N W) direction at a node: by how much an impulse moves it along itself when the rods
// keep their lengths. A plumb column does not let its hem down at all. With A_ww = L D L^T the rods' part is the sum of
// y^2 / D, y = L^-1 N W direction, and y is 0 above the node.
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

void NetSolver::findPushed() noexcept {
  std::fill(pushed_.begin(), pushed_.end(), std::uint8_t{0});
  rows_.forEachNode([this](std::uint32_t node) { pushed_[node / kColumns] = 1; });
}

// The loop ends before non-finite numbers reach the vectors.
NetSolver::Outcome NetSolver::solve(const Field& violation, const Field& active, Rows& rows, const Aim& aim,
                                    Field& change) noexcept {
  Outcome outcome;
  damping_ = static_cast<float>(aim.damping);
  violation_scale_ = aim.largest;
  const bool changes = aim.multiplier != nullptr &&
                       std::all_of(rows.begin(), rows.end(), [](const Row& one) { return one.min_damping == 0.0; });
  loadRows(rows, changes);
  findPushed();
  workers_.run(row_blocks_, [&](int b) { load(violation, active, aim, b); });
  if (guided_ != nullptr) leaveOutFixedLinks();
  sumOverRowBlocks([&](int b) {
    factorWeft(b);
    return 0.0;
  });
  double aligned = 0.0;
  bool restart = true;
  outcome.reduction = 1.0;
  while (true) {
    const double next = sumOverRowBlocks([&](int b) { return precondition(b); }) + rows_.aligned();
    const float beta = restart ? 0.0F : static_cast<float>(next / aligned);
    aligned = next;
    restart = false;
    if (outcome.iterations >= aim.max_iterations || !(aligned > 0.0)) break;
    ++outcome.iterations;
    sumOverRowBlocks([&](int b) {
      conjugate(b, beta);
      return 0.0;
    });
    rows_.turn(beta, pushes());
    if (guided_ != nullptr) keepFreedom(push_, 0, pattern_.grid.columns);
    const double curvature = applySchur();
    const auto alpha = static_cast<float>(aligned / curvature);
    if (!(curvature > 0.0) || !std::isfinite(alpha)) break;
    outcome.reduction = step(alpha);
    if (outcome.reduction > aim.reduction) continue;
    restart = changes && changeStrings(static_cast<float>(aim.reduction));
    if (!restart) break;
  }
  workers_.run(row_blocks_, [&](int b) { unload(b, aim.multiplier, change); });
  rows_.unload(multiplierScale(), rows);
  return outcome;
}

void NetSolver::rodsAnswer(const Field& strings, Rows& rows, Field& out) noexcept {
  const double per_multiplier = 1.0 / multiplierScale();
  for (int i = 0; i < pattern_.grid.rows; ++i) {
    const std::size_t from = pattern_.grid.row(i), to = row(i);
    for (std::size_t j = 0; j < static_cast<std::size_t>(pattern_.grid.columns); ++j)
      pull_[to + j] = static_cast<float>(strings[from + j] * pattern_.weft_rest[from + j] * per_multiplier);
  }
  rows_.conclude(pushes());
  rows_.unload(multiplierScale(), rows);
  if (guided_ != nullptr) keepFreedom(push_, 0, pattern_.grid.columns);
  closeRows(pull_);
  workers_.run(column_blocks_, [&](int b) { answerOfRods(b); });
  rows_.forEachNode([this](std::uint32_t n) { push_.x[n] = push_.y[n] = push_.z[n] = 0.0F; });
  const double scale = -multiplierScale();
  const Grid& grid = pattern_.grid;
  for (int i = 1; i < grid.rows; ++i) {
    const std::size_t from = row(i), to = grid.row(i);
    for (std::size_t j = 0; j < static_cast<std::size_t>(grid.columns); ++j)
      out[to + j] = scale * static_cast<double>(rods_[from + j]) * per_warp_rest_[to + j];
  }
}

}  // namespace curtain
