// SPDX-License-Identifier: BSD-3-Clause
#include "contact/broad_phase/flat_patches.h"

#include <algorithm>
#include <cmath>

#include "contact/narrow_phase/simd8.h"

namespace curtain {
namespace {

using Lanes = Simd8::Lanes;

/// One component of a strip of quads (a row of patches): positions at both instants, and where the ranges go.
struct Strip {
  const float *start, *end;
  std::size_t stride;  // of both
  std::size_t links;   // of a row
  int rows;            // of quads
  const float *per_spacing_u, *per_spacing_v;
  float *low, *high, *u_low, *u_high, *v_low, *v_high;
};

CURTAIN_INTO_WIDE void widen(const Lanes& value, Lanes& low, Lanes& high) {
  Simd8::lower(low, value);
  Simd8::raise(high, value);
}

// Ranges over four columns from each on: of their nodes, of the weft links on their right, of their warp links.
CURTAIN_WIDE void columnRanges(const Strip& s) {
  for (std::size_t j = 0; j <= s.links; j += Simd8::kCount) {
    const float *start = s.start + j, *end = s.end + j;
    Lanes p, q, next;
    Simd8::load(start, p);
    Simd8::load(end, q);
    Simd8::load(start + 1, next);
    Lanes low = p, high = p, u_low = next - p, u_high = u_low, v_low, v_high;
    widen(q, low, high);
    Simd8::load(end + 1, next);
    widen(next - q, u_low, u_high);
    v_low = Lanes{} + 1e30f;
    v_high = Lanes{} - 1e30f;
    for (int i = 0; i < s.rows; ++i) {
      start += s.stride;
      end += s.stride;
      Lanes below_p, below_q;
      Simd8::load(start, below_p);
      Simd8::load(end, below_q);
      widen((below_p - p) * s.per_spacing_v[i], v_low, v_high);
      widen((below_q - q) * s.per_spacing_v[i], v_low, v_high);
      p = below_p;
      q = below_q;
      widen(p, low, high);
      widen(q, low, high);
      Simd8::load(start + 1, next);
      widen(next - p, u_low, u_high);
      Simd8::load(end + 1, next);
      widen(next - q, u_low, u_high);
    }
    Lanes per_spacing_u;
    Simd8::load(s.per_spacing_u + j, per_spacing_u);
    Simd8::store(low, s.low + j);
    Simd8::store(high, s.high + j);
    Simd8::store(u_low * per_spacing_u, s.u_low + j);
    Simd8::store(u_high * per_spacing_u, s.u_high + j);
    Simd8::store(v_low, s.v_low + j);
    Simd8::store(v_high, s.v_high + j);
  }
  Simd8::reduceFours(s.low, s.links + 1, true);
  Simd8::reduceFours(s.high, s.links + 1, false);
  Simd8::reduceFours(s.u_low, s.links, true);
  Simd8::reduceFours(s.u_high, s.links, false);
  Simd8::reduceFours(s.v_low, s.links + 1, true);
  Simd8::reduceFours(s.v_high, s.links + 1, false);
}

float maxOf(const float* from, const float* to) { return *std::max_element(from, to); }

}  // namespace

FlatPatches::FlatPatches(const Grid& grid, const Spacings& per_spacing)
    : grid_(grid),
      rows_((grid.rows - 1 + kAlong - 1) / kAlong),
      columns_((grid.linkCount() + kAlong - 1) / kAlong),
      per_spacing_(per_spacing) {
  const auto padded = static_cast<std::size_t>(Grid::strideFor(grid_.columns + 2)) + 2 * Simd8::kCount;
  for (SweptNodes::Floats& floats : ranges_) floats.assign(padded, 0.0f);
  slopes_.resize(static_cast<std::size_t>(rows_ * columns_));
  boxes_.assign(slopes_.size(), {Eigen::Array4f::Zero(), Eigen::Array4f::Zero()});
  flat_.assign(slopes_.size(), 0);
  for (int i = 0; i < rows_; ++i) {
    for (int j = 0; j < columns_; ++j) {
      Slopes& slopes = slopes_[at(i, j)];
      const auto largest = [&](const Spacings::Floats& per, int at, int count) {
        return maxOf(per.data() + at * kAlong, per.data() + std::min((at + 1) * kAlong, count));
      };
      slopes.u.low = slopes.u.high = slopes.v.low = slopes.v.high = Eigen::Array4f::Zero();
      slopes.spacing_u = 1.0f / largest(per_spacing_.u, j, grid_.linkCount());
      slopes.spacing_v = 1.0f / largest(per_spacing_.v, i, grid_.rows - 1);
    }
  }
}

void FlatPatches::measureRow(const SweptNodes& nodes, int row) noexcept {
  const int first_row = row * kAlong, rows = std::min(kAlong, grid_.rows - 1 - first_row);
  const auto links = static_cast<std::size_t>(grid_.linkCount());
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t first = grid_.row(first_row);
    const auto out = [&](std::size_t what) { return ranges_[6 * k + what].data(); };
    columnRanges({&nodes.start()[k][first], &nodes.end()[k][first], static_cast<std::size_t>(grid_.stride), links, rows,
                  per_spacing_.u.data(), per_spacing_.v.data() + first_row, out(0), out(1), out(2), out(3), out(4),
                  out(5)});
    for (int column = 0; column < columns_; ++column) {
      Slopes& slopes = slopes_[at(row, column)];
      MovingBox& box = boxes_[at(row, column)];
      const auto axis = static_cast<Eigen::Index>(k);
      const auto from = static_cast<std::size_t>(column * kAlong);  // nodes: of five columns
      box.low[axis] = std::min(out(0)[from], out(0)[from + 1]);
      box.high[axis] = std::max(out(1)[from], out(1)[from + 1]);
      slopes.u.low[axis] = out(2)[from];
      slopes.u.high[axis] = out(3)[from];
      slopes.v.low[axis] = std::min(out(4)[from], out(4)[from + 1]);
      slopes.v.high[axis] = std::max(out(5)[from], out(5)[from + 1]);
    }
  }
}

float FlatPatches::largest() const noexcept {
  Eigen::Array4f largest = Eigen::Array4f::Zero();
  for (const MovingBox& box : boxes_) largest = largest.max(box.low.abs()).max(box.high.abs());
  return largest.maxCoeff();
}

bool FlatPatches::find(float reach, float rounding) noexcept {
  bool all = true;
  for (int i = 0; i < rows_; ++i) {
    for (int j = 0; j < columns_; ++j) {
      const int below = std::min(i + 1, rows_ - 1), right = std::min(j + 1, columns_ - 1);
      Slopes window = slopes_[at(i, j)];
      window.merge(slopes_[at(i, right)]);
      window.merge(slopes_[at(below, j)]);
      window.merge(slopes_[at(below, right)]);
      // The neighbours on the right of closed cloth's last patches are the first.
      if (grid_.closed && j == columns_ - 1) {
        window.merge(slopes_[at(i, 0)]);
        window.merge(slopes_[at(below, 0)]);
      }
      const bool flat = keepsApart(window, reach, rounding);
      flat_[at(i, j)] = flat ? 1 : 0;
      all = all && flat;
    }
  }
  return all;
}

// Single precision: `rounding` and some ulps of every quotient, centre and half edge are added.
bool FlatPatches::keepsApart(const Slopes& patch, float reach, float rounding) noexcept {
  using Eigen::Array4f;
  constexpr float kUlps = 1e-6f;   // of a slope: rounding of the quotient and of the box's centre and half edges
  constexpr float kSlack = 2e-5f;  // of lambda: rounding of U, V, a, b, worst for c near 1
  constexpr float kMinSine = 0.1f;
  const Array4f mid_u = 0.5f * (patch.u.low + patch.u.high), mid_v = 0.5f * (patch.v.low + patch.v.high);
  const Array4f half_u = 0.5f * (patch.u.high - patch.u.low), half_v = 0.5f * (patch.v.high - patch.v.low);
  const float squared_u = (mid_u * mid_u).sum(), squared_v = (mid_v * mid_v).sum();
  const float side_u = patch.spacing_u * patch.spacing_u * squared_u;  // [m^2]
  const float side_v = patch.spacing_v * patch.spacing_v * squared_v;
  // Early out without a square root: the triangles are lower than the reach, or a slope deviates by more than its
  // mean.
  const bool hopeless = !(side_u * side_v > reach * reach * (side_u + side_v)) ||
                        !((mid_u.abs() * half_u).sum() < squared_u) || !((mid_v.abs() * half_v).sum() < squared_v) ||
                        !(std::min(squared_u, squared_v) > 1e-6f);
  if (hopeless) return false;
  const float per_u = 1.0f / std::sqrt(squared_u), per_v = 1.0f / std::sqrt(squared_v);
  const Array4f unit_u = mid_u * per_u, unit_v = mid_v * per_v;
  const float cosine = (unit_u * unit_v).sum();
  const float plus = std::sqrt(std::max(0.0f, 1.0f + cosine)), minus = std::sqrt(std::max(0.0f, 1.0f - cosine));
  const float lambda = std::min(plus, minus);
  if (!(lambda > kMinSine)) return false;
  const Array4f mean = (unit_u + unit_v) * (0.5f / plus), skew = (unit_u - unit_v) * (0.5f / minus);
  const Array4f a = (mean + skew).abs(), b = (mean - skew).abs();
  const Array4f max_u = (half_u + (rounding / patch.spacing_u + kUlps)) * per_u + kUlps;
  const Array4f max_v = (half_v + (rounding / patch.spacing_v + kUlps)) * per_v + kUlps;
  const float along_a = (a * max_u).sum(), along_b = (b * max_v).sum();
  const float across = 0.5f * ((b * max_u).sum() + (a * max_v).sum());
  const float half = 0.5f * (along_a - along_b);
  const float deviation = 0.5f * (along_a + along_b) + std::sqrt(half * half + across * across);
  const float least = lambda - deviation - kSlack;
  const float altitude_squared = side_u * side_v / (side_u + side_v);
  return least > 0.0f && least * least * altitude_squared * (1.0f - 1e-5f) > reach * reach;
}

}  // namespace curtain
