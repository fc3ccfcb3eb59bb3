// SPDX-License-Identifier: BSD-3-Clause
//
// What is constant of the lines, and their forces where no node gives way.
#include "parts/bending/bending_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cloth/wide.h"

namespace curtain {
namespace {

// By links; and row sums of |K|: of joint i, k_i |c_r| (|a_i| + |a_i + a_(i+1)| + |a_(i+1)|) at each of its three nodes
// r. before, after: the index of a node's neighbour.
// Joints that turn at rest also have couples, of k |sin(theta_0)| (rest_curvature.h).
template <typename Before, typename After>
void fillMatrix(const Grid& grid, const Field& rest_turn, const Before& before, const After& after,
                BendingLines& lines) {
  for (Field* field : {&lines.bound, &lines.own, &lines.joined}) field->assign(grid.size(), 0.0);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      const std::size_t n = grid.index(i, j);
      const double k = lines.stiffness[n];
      if (k == 0.0) continue;
      const double a = lines.per_rest[n], b = lines.per_rest[after(i, j)], sum = 2.0 * (a + b);
      const bool seam_before = before(i, j) > n, seam_after = after(i, j) < n;  // the link that closes a ring
      if (!seam_before) lines.own[n] += k * a * a;
      if (!seam_after) lines.own[after(i, j)] += k * b * b;
      if (!seam_before && !seam_after) lines.joined[after(i, j)] = k * a * b;
      const double most = rest_turn.empty() ? k : k * (1.0 + std::abs(std::tan(rest_turn[n])));
      lines.bound[before(i, j)] += most * a * sum;
      lines.bound[n] += most * (a + b) * sum;
      lines.bound[after(i, j)] += most * b * sum;
    }
  }
}

void fillStiffness(const Field& bending, const Field& rest_turn, Field& stiffness) {
  stiffness = bending;
  for (std::size_t n = 0; n < rest_turn.size() && n < stiffness.size(); ++n) stiffness[n] *= std::cos(rest_turn[n]);
}

void fillCompliance(BendingLines& lines) {
  lines.compliance.assign(lines.stiffness.size(), std::numeric_limits<double>::infinity());
  for (std::size_t n = 0; n < lines.stiffness.size(); ++n) {
    if (lines.stiffness[n] > 0.0) lines.compliance[n] = 1.0 / lines.stiffness[n];
  }
}

}  // namespace

void fillWarpLines(const ClothPattern& pattern, BendingLines& lines) noexcept {
  const Grid& grid = pattern.grid;
  fillStiffness(pattern.warp_bending, pattern.warp_rest_turn, lines.stiffness);
  if (!lines.bend()) return;
  lines.per_rest.assign(grid.size(), 0.0);
  for (std::size_t n = grid.row(1); n < grid.size(); ++n) lines.per_rest[n] = 1.0 / pattern.warp_rest[n];
  fillMatrix(
      grid, pattern.warp_rest_turn, [&](int i, int j) { return grid.index(i - 1, j); },
      [&](int i, int j) { return grid.index(i + 1, j); }, lines);
  fillCompliance(lines);
}

void fillWeftLines(const ClothPattern& pattern, BendingLines& lines) noexcept {
  const Grid& grid = pattern.grid;
  fillStiffness(pattern.weft_bending, pattern.weft_rest_turn, lines.stiffness);
  if (!lines.bend()) return;
  lines.per_rest.assign(grid.size(), 0.0);
  for (int i = 0; i < grid.rows; ++i) {
    for (int j = 0; j < grid.columns; ++j) {
      if (grid.hasLink(i, j)) lines.per_rest[grid.index(i, j)] = 1.0 / pattern.weft_rest[grid.index(i, j)];
    }
  }
  const int last = grid.columns - 1;
  fillMatrix(
      grid, pattern.weft_rest_turn, [&](int i, int j) { return grid.index(i, j > 0 ? j - 1 : last); },
      [&](int i, int j) { return grid.index(i, j < last ? j + 1 : 0); }, lines);
  lines.string = lines.per_rest;
  for (int i = 0; i < grid.rows && !pattern.weft_rest_turn.empty(); ++i) {
    const auto row = lines.string.begin() + static_cast<std::ptrdiff_t>(grid.row(i));
    const auto turn = pattern.weft_rest_turn.begin() + static_cast<std::ptrdiff_t>(grid.row(i));
    if (std::any_of(turn, turn + grid.columns, [](double angle) { return angle != 0.0; }))
      std::fill(row, row + grid.columns, 0.0);
  }
  fillCompliance(lines);
}

BendingLines warpLines(const ClothPattern& pattern) {
  BendingLines lines;
  fillWarpLines(pattern, lines);
  return lines;
}

BendingLines weftLines(const ClothPattern& pattern) {
  BendingLines lines;
  fillWeftLines(pattern, lines);
  return lines;
}

void BendingScratch::assign(const Grid& grid) {
  const auto lanes = static_cast<std::size_t>(kLane);
  const auto blocks = (static_cast<std::size_t>(grid.rows) + lanes - 1) / lanes;
  const std::size_t size = std::max(grid.size(), blocks * lanes * static_cast<std::size_t>(grid.columns));
  for (Field* field : {&x, &y, &z, &give, &per_rest, &compliance, &pivot, &near, &far, &border, &last, &mx, &my, &mz})
    field->assign(size, 0.0);
}

namespace {

// One coordinate of a block of warp lines, from top to bottom: the links above and below a node, and the next one.
CURTAIN_INTO_WIDE void bendColumns(const Grid& grid, const BendingLines& lines, std::size_t offset, const double* outer,
                                   const double* x, double* sum) {
  const auto stride = static_cast<std::size_t>(grid.stride);
  const double* const own = lines.own.data();
  const double* const joined = lines.joined.data();
  double above[kLane] = {}, below[kLane], shear[kLane] = {};
  for (std::size_t j = 0; j < kLane; ++j) below[j] = x[offset + stride + j] - x[offset + j];
  const std::size_t last = grid.row(grid.rows - 1) + offset;
  for (std::size_t n = offset; n < last; n += stride) {
    const std::size_t one = n + stride, two = one < last ? one + stride : one;
#pragma omp simd
    for (std::size_t j = 0; j < kLane; ++j) {
      const double next = x[two + j] - x[one + j];
      const double q = own[one + j] * below[j] - joined[one + j] * above[j] - joined[two + j] * next;
      sum[n + j] = outer[n + j] - (shear[j] - q);
      above[j] = below[j];
      below[j] = next;
      shear[j] = q;
    }
  }
  for (std::size_t j = 0; j < kLane; ++j) sum[last + j] = outer[last + j] - shear[j];
}

// The shear of link n, whose row's neighbours are beside it.
CURTAIN_INTO_WIDE double shearOf(const double* own, const double* joined, const double* x, std::size_t n) {
  return own[n] * (x[n] - x[n - 1]) - joined[n] * (x[n - 1] - x[n - 2]) - joined[n + 1] * (x[n + 1] - x[n]);
}

// The same for the first and the last links of all, which have fewer neighbours.
double shearAtEnd(const BendingLines& lines, const Field& x, std::size_t n) {
  if (n == 0) return 0.0;
  double shear = lines.own[n] * (x[n] - x[n - 1]);
  if (n + 1 < x.size()) shear -= lines.joined[n + 1] * (x[n + 1] - x[n]);
  if (n > 1) shear -= lines.joined[n] * (x[n - 1] - x[n - 2]);
  return shear;
}

// The link that closes row i to a ring: its shear, and what it adds to those of its neighbours.
void closeRow(const Grid& grid, const BendingLines& lines, int i, const Field& x, Field& q) {
  const std::size_t first = grid.row(i), last = first + static_cast<std::size_t>(grid.columns) - 1;
  const Field& a = lines.per_rest;
  const Field& k = lines.stiffness;
  const double seam = x[first] - x[last];
  const double before = a[first] * a[last] * k[last], after = a[first + 1] * a[first] * k[first];
  q[first] = a[first] * a[first] * (k[last] + k[first]) * seam - before * (x[last] - x[last - 1]) -
             after * (x[first + 1] - x[first]);
  q[first + 1] -= after * seam;
  q[last] -= before * seam;
}

}  // namespace

CURTAIN_WIDE void bendWarp(const Grid& grid, const BendingLines& lines, const Field3& force, const Field3& position,
                           int block, Field3& sum) noexcept {
  const auto offset = static_cast<std::size_t>(block) * kLane;
  bendColumns(grid, lines, offset, force.x.data(), position.x.data(), sum.x.data());
  bendColumns(grid, lines, offset, force.y.data(), position.y.data(), sum.y.data());
  bendColumns(grid, lines, offset, force.z.data(), position.z.data(), sum.z.data());
}

// Rows follow one another in a field: links between them, and in the padding, have no stiffness.
CURTAIN_WIDE void bendWeft(const Grid& grid, const BendingLines& lines, const Field3& position, int block,
                           WeftShears& shears, Field3& sum) noexcept {
  const int top = block * kLane, bottom = std::min(top + kLane, grid.rows);
  const std::size_t begin = grid.row(top), end = grid.row(bottom);
  const std::size_t first = std::max(begin, std::size_t{2}), last = std::min(end, grid.size() - 1);
  const double* const own = lines.own.data();
  const double* const joined = lines.joined.data();
  const ConstFieldView x(position, 0);
  const FieldView q(shears.q, 0);
#pragma omp simd
  for (std::size_t n = first; n < last; ++n) {
    q.x[n] = shearOf(own, joined, x.x, n);
    q.y[n] = shearOf(own, joined, x.y, n);
    q.z[n] = shearOf(own, joined, x.z, n);
  }
  const auto end_link = [&](std::size_t n) {
    q.x[n] = shearAtEnd(lines, position.x, n);
    q.y[n] = shearAtEnd(lines, position.y, n);
    q.z[n] = shearAtEnd(lines, position.z, n);
  };
  for (std::size_t n = begin; n < first; ++n) end_link(n);
  for (std::size_t n = last; n < end; ++n) end_link(n);
  for (int i = top; grid.closed && i < bottom; ++i) {
    closeRow(grid, lines, i, position.x, shears.q.x);
    closeRow(grid, lines, i, position.y, shears.q.y);
    closeRow(grid, lines, i, position.z, shears.q.z);
  }
  addShears(grid, lines.string, position, block, shears.q, &shears.spared, sum);
}

}  // namespace curtain
