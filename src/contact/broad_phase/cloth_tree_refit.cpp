// SPDX-License-Identifier: BSD-3-Clause
//
// Boxes and slopes of the tree: of whole blocks at every refit, of what lies below them on demand.
#include <algorithm>
#include <cstring>
#include <limits>

#include "cloth/wide.h"
#include "contact/broad_phase/cloth_tree.h"

namespace curtain {
namespace {

using Eigen::Array4f;

/// Largest error of a number rounded to single precision, relative to it.
constexpr float kUnit = 0.5f * std::numeric_limits<float>::epsilon();

constexpr std::size_t kLanes = 8;

float lesser(float a, float b) { return a < b ? a : b; }
float greater(float a, float b) { return a > b ? a : b; }

CURTAIN_WIDE void copyRow(const double* __restrict from, double origin, std::size_t count, float* __restrict to) {
#pragma omp simd
  for (std::size_t j = 0; j < count; ++j) to[j] = static_cast<float>(from[j] - origin);
}

/// One component of a strip of quads: positions at both instants, and where the result goes.
struct Strip {
  const float* __restrict start;
  const float* __restrict end;
  std::size_t stride;   // of both
  std::size_t columns;  // of nodes
  int rows;             // of quads
  const float* __restrict per_spacing_u;
  const float* __restrict per_spacing_v;
  float* __restrict low, * __restrict high;
  float* __restrict u_low, * __restrict u_high;
  float* __restrict v_low, * __restrict v_high;
};

/// Neighbouring columns side by side. Spelled out, for no compiler tried keeps the extremes of a column in registers
/// down the rows when asked to vectorise across columns.
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));

CURTAIN_INTO_WIDE void lower(Lanes& least, const Lanes& value) { least = value < least ? value : least; }
CURTAIN_INTO_WIDE void raise(Lanes& greatest, const Lanes& value) { greatest = value > greatest ? value : greatest; }
// A copy: clang takes a vector behind a pointer for aligned whatever its type says. Not a function's result: vectors wider
// than the machine's have no settled way of being returned.
struct Loaded {
  CURTAIN_INTO_WIDE explicit Loaded(const float* from) { std::memcpy(&value, from, sizeof value); }
  Lanes value;
};
CURTAIN_INTO_WIDE void store(const Lanes& value, float* to) { std::memcpy(to, &value, sizeof value); }

// Of every column: what its nodes, the links to the next column and its rods are within. The value of u in the last
// column means nothing.
CURTAIN_WIDE void columnRanges(const Strip& s) {
  for (std::size_t j = 0; j < s.columns; j += kLanes) {
    const float *start = s.start + j, *end = s.end + j;
    Lanes p = Loaded(start).value, q = Loaded(end).value;
    Lanes low = p, high = p;
    lower(low, q);
    raise(high, q);
    Lanes u = Loaded(start + 1).value - p;
    Lanes u_low = u, u_high = u;
    u = Loaded(end + 1).value - q;
    lower(u_low, u);
    raise(u_high, u);
    Lanes v_low = (Loaded(start + s.stride).value - p) * s.per_spacing_v[0];
    Lanes v_high = v_low;
    for (int i = 0; i < s.rows; ++i) {
      start += s.stride;
      end += s.stride;
      const Lanes next_p = Loaded(start).value, next_q = Loaded(end).value;
      Lanes v = (next_p - p) * s.per_spacing_v[i];
      lower(v_low, v);
      raise(v_high, v);
      v = (next_q - q) * s.per_spacing_v[i];
      lower(v_low, v);
      raise(v_high, v);
      p = next_p;
      q = next_q;
      lower(low, p);
      raise(high, p);
      lower(low, q);
      raise(high, q);
      u = Loaded(start + 1).value - p;
      lower(u_low, u);
      raise(u_high, u);
      u = Loaded(end + 1).value - q;
      lower(u_low, u);
      raise(u_high, u);
    }
    const Lanes per_spacing_u = Loaded(s.per_spacing_u + j).value;
    store(low, s.low + j);
    store(high, s.high + j);
    store(u_low * per_spacing_u, s.u_low + j);
    store(u_high * per_spacing_u, s.u_high + j);
    store(v_low, s.v_low + j);
    store(v_high, s.v_high + j);
  }
}

float leastOf(const float* from, const float* to) {
  float least = *from;
  while (++from != to) least = lesser(least, *from);
  return least;
}

float greatestOf(const float* from, const float* to) {
  float greatest = *from;
  while (++from != to) greatest = greater(greatest, *from);
  return greatest;
}

}  // namespace

void ClothTree::refit(const Field3& start, const Field3& end) noexcept {
  copyPositions(start, end);
  for (std::size_t strip = 0; strip + 1 < row_bounds_.size(); ++strip) refitStrip(strip);
  for (Block& block : blocks_) block.filled = false;
  ++refits_;
  for (const std::uint32_t node : upper_) mergeChildren(node);
  const FloatBox& all = boxes_[0];
  rounding_ = roundingOf(all.low.abs().max(all.high.abs()).maxCoeff(), origin_);
}

float ClothTree::roundingOf(float largest, const Vec3& origin) noexcept {
  // Each of two coordinates is rounded once, and so is their difference, which is at most twice as large; the step to
  // the origin rounds in double precision.
  return 4.0f * kUnit * largest + 1e-15f * static_cast<float>(origin.cwiseAbs().maxCoeff());
}

void ClothTree::copyPositions(const Field3& start, const Field3& end) noexcept {
  origin_ = start.at(0);
  const auto rows = static_cast<std::size_t>(grid_.rows), from = static_cast<std::size_t>(grid_.stride);
  const auto copy = [&](const Field& field, double origin, Floats& to) {
    if (from == stride_) {
      copyRow(field.data(), origin, rows * from, to.data());
    } else {
      for (std::size_t i = 0; i < rows; ++i) copyRow(field.data() + i * from, origin, from, to.data() + i * stride_);
    }
    if (!grid_.closed) return;
    const auto seam = static_cast<std::size_t>(grid_.columns);
    for (std::size_t i = 0; i < rows; ++i) to[i * stride_ + seam] = to[i * stride_];
  };
  copy(start.x, origin_.x(), start_[0]);
  copy(start.y, origin_.y(), start_[1]);
  copy(start.z, origin_.z(), start_[2]);
  copy(end.x, origin_.x(), end_[0]);
  copy(end.y, origin_.y(), end_[1]);
  copy(end.z, origin_.z(), end_[2]);
}

void ClothTree::refitStrip(std::size_t strip) noexcept {
  const auto row = static_cast<std::size_t>(row_bounds_[strip]);
  const auto columns = (static_cast<std::size_t>(grid_.linkCount()) + kLanes) / kLanes * kLanes;  // padding too
  for (std::size_t k = 0; k < 3; ++k) {
    const auto out = [&](std::size_t what) { return columns_[6 * k + what].data(); };
    columnRanges({start_[k].data() + row * stride_, end_[k].data() + row * stride_, stride_, columns,
                  row_bounds_[strip + 1] - row_bounds_[strip], per_spacing_u_.data(), per_spacing_v_.data() + row,
                  out(0), out(1), out(2), out(3), out(4), out(5)});
  }
  const std::size_t across = column_bounds_.size() - 1;
  for (std::size_t b = 0; b < across; ++b) {
    const std::uint32_t node = blocks_[strip * across + b].node;
    FloatBox& box = boxes_[node];
    PatchSlopes& slopes = slopes_[node];
    const int first = column_bounds_[b], last = column_bounds_[b + 1];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      const auto low = [&](std::size_t what, int end) {
        const float* const values = columns_[6 * k + what].data();
        return leastOf(values + first, values + end);
      };
      const auto high = [&](std::size_t what, int end) {
        const float* const values = columns_[6 * k + what].data();
        return greatestOf(values + first, values + end);
      };
      box.low[axis] = low(0, last + 1);
      box.high[axis] = high(1, last + 1);
      slopes.u.low[axis] = low(2, last);
      slopes.u.high[axis] = high(3, last);
      slopes.v.low[axis] = low(4, last + 1);
      slopes.v.high[axis] = high(5, last + 1);
    }
  }
}

void ClothTree::mergeChildren(std::uint32_t node) noexcept {
  const std::uint32_t first = node + 1, second = nodes_[node].second;
  boxes_[node] = boxes_[first];
  boxes_[node].merge(boxes_[second]);
  slopes_[node] = slopes_[first];
  slopes_[node].merge(slopes_[second]);
}

void ClothTree::fillBlock(std::uint32_t root) noexcept {
  const QuadRectangle& whole = nodes_[root].quads;
  constexpr std::size_t kSide = kBlock + 1;
  std::array<Array4f, kSide * kSide> start, end;
  for (int i = whole.row; i <= whole.row_end; ++i) {
    for (int j = whole.column; j <= whole.column_end; ++j) {
      const std::size_t from = static_cast<std::size_t>(i) * stride_ + static_cast<std::size_t>(j);
      const std::size_t to =
          static_cast<std::size_t>(i - whole.row) * kSide + static_cast<std::size_t>(j - whole.column);
      start[to] = Array4f(start_[0][from], start_[1][from], start_[2][from], 0.0f);
      end[to] = Array4f(end_[0][from], end_[1][from], end_[2][from], 0.0f);
      ways_[grid_.index(i, j < grid_.columns ? j : 0)] = {start[to], end[to]};
    }
  }
  for (std::uint32_t node = nodes_[root].end; node-- > root;) {
    if (nodes_[node].second != kNone) {
      mergeChildren(node);
      continue;
    }
    const QuadRectangle& at = nodes_[node].quads;
    const auto corner =
        static_cast<std::size_t>(at.row - whole.row) * kSide + static_cast<std::size_t>(at.column - whole.column);
    fillQuad(node, start.data() + corner, end.data() + corner);
  }
}

void ClothTree::fillQuad(std::uint32_t node, const Array4f* start, const Array4f* end) noexcept {
  constexpr std::size_t kDown = kBlock + 1;
  const QuadRectangle& at = nodes_[node].quads;
  const float per_u = per_spacing_u_[static_cast<std::size_t>(at.column)];
  const float per_v = per_spacing_v_[static_cast<std::size_t>(at.row)];
  const auto within = [](const Array4f& p, const Array4f& q, const Array4f& r, const Array4f& s, float scale) {
    return FloatBox{p.min(q).min(r.min(s)) * scale, p.max(q).max(r.max(s)) * scale};
  };
  boxes_[node] = within(start[0], start[1], start[kDown], start[kDown + 1], 1.0f);
  boxes_[node].merge(within(end[0], end[1], end[kDown], end[kDown + 1], 1.0f));
  slopes_[node].u =
      within(start[1] - start[0], start[kDown + 1] - start[kDown], end[1] - end[0], end[kDown + 1] - end[kDown], per_u);
  slopes_[node].v =
      within(start[kDown] - start[0], start[kDown + 1] - start[1], end[kDown] - end[0], end[kDown + 1] - end[1], per_v);
}

}  // namespace curtain
