// SPDX-License-Identifier: BSD-3-Clause
//
// Windows of 2 x 2 quads: flat or not, triangle by triangle (contact/narrow_phase/flatness.h has the bound). Boxes of slopes along the
// axes say of few folds that they are open; a window has so few triangles that each is looked at by itself.
#include <algorithm>

#include "contact/broad_phase/cloth_tree.h"
#include "contact/narrow_phase/lanes.h"

namespace curtain {
namespace {

/// Derivatives along weft and warp of four windows side by side, at one instant.
struct WindowSlopes {
  LaneVectors u[3][2], v[2][3];

  LaneVectors sumU() const noexcept { return u[0][0] + u[0][1] + (u[1][0] + u[1][1]) + (u[2][0] + u[2][1]); }
  LaneVectors sumV() const noexcept { return v[0][0] + v[0][1] + v[0][2] + (v[1][0] + v[1][1] + v[1][2]); }
};

/// Components along the two directions.
struct Projected {
  Lanes a, b;
};

}  // namespace

// Four windows side by side from this one on: those that are flat, as bits; what they hold beyond the cloth means nothing.
std::uint32_t ClothTree::flatWindows(std::size_t row, std::size_t column) const noexcept {
  constexpr float kLeastSine = 0.01f;  // squared
  const Lanes per_u[2] = {loadLanes(&per_spacing_u_[column]), loadLanes(&per_spacing_u_[column + 1])};
  const Lanes per_v[2] = {lanesOf(per_spacing_v_[row]), lanesOf(per_spacing_v_[row + 1])};
  WindowSlopes slopes[2];
  for (std::size_t instant = 0; instant < 2; ++instant) {
    const std::array<Floats, 3>& places = instant == 0 ? start_ : end_;
    LaneVectors at[3][3];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t node = (row + i) * stride_ + column + j;
        at[i][j] = {loadLanes(&places[0][node]), loadLanes(&places[1][node]), loadLanes(&places[2][node])};
      }
    }
    WindowSlopes& s = slopes[instant];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 2; ++j) s.u[i][j] = per_u[j] * (at[i][j + 1] - at[i][j]);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 3; ++j) s.v[i][j] = per_v[i] * (at[i + 1][j] - at[i][j]);
    }
  }
  const LaneVectors mean_u = slopes[0].sumU() + slopes[1].sumU(), mean_v = slopes[0].sumV() + slopes[1].sumV();
  const Lanes one = lanesOf(1.0f), tiny = lanesOf(1e-20f);
  const LaneVectors unit_u = one / rootOf(dot(mean_u, mean_u) + tiny) * mean_u;
  const LaneVectors unit_v = one / rootOf(dot(mean_v, mean_v) + tiny) * mean_v;
  const Lanes cosine = dot(unit_u, unit_v);
  const Lanes plus = one + cosine, minus = one - cosine;
  const LaneVectors mean = lanesOf(0.5f) / rootOf(greater(plus, tiny)) * (unit_u + unit_v);
  const LaneVectors skew = lanesOf(0.5f) / rootOf(greater(minus, tiny)) * (unit_u - unit_v);
  const LaneVectors a = mean + skew, b = mean - skew;
  // What lambda must exceed: reach / altitude of the smallest triangle. Slopes are rounded by a few units of the largest
  // coordinate over the spacing, the directions by some of 1.
  const Lanes most_u = greater(per_u[0], per_u[1]), most_v = greater(per_v[0], per_v[1]);
  const Lanes limit = lanesOf(1.0f + 1e-4f) * (lanesOf(reach_) * rootOf(most_u * most_u + most_v * most_v) +
                                               lanesOf(16.0f * rounding_) * greater(most_u, most_v)) + lanesOf(2e-5f);
  auto flat = (lesser(plus, minus) > lanesOf(kLeastSine)) & (lesser(dot(mean_u, mean_u), dot(mean_v, mean_v)) > lanesOf(1e-4f));
  for (const WindowSlopes& s : slopes) {
    Projected u[3][2], v[2][3];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 2; ++j) u[i][j] = {dot(s.u[i][j], a) - limit, dot(s.u[i][j], b)};
    }
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 3; ++j) v[i][j] = {dot(s.v[i][j], a), dot(s.v[i][j], b) - limit};
    }
    // Both eigenvalues of the symmetric part exceed the limit.
    const auto narrow = [&flat](const Projected& du, const Projected& dv) {
      const Lanes across = lanesOf(0.5f) * (du.b + dv.a);
      flat &= (du.a > Lanes{}) & (dv.b > Lanes{}) & (du.a * dv.b > across * across);
    };
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) {
        narrow(u[i][j], v[i][j]);
        narrow(u[i + 1][j], v[i][j + 1]);
      }
    }
  }
  std::uint32_t bits = 0;
  for (std::size_t k = 0; k < 4; ++k) bits |= (flat[k] != 0 ? 1U : 0U) << k;
  return bits;
}

bool ClothTree::isWindowFlat(int row, int column) noexcept {
  const std::size_t group = static_cast<std::size_t>(row) * window_groups_ + static_cast<std::size_t>(column) / 4;
  if (window_queries_[group] != queries_) {
    window_queries_[group] = queries_;
    windows_flat_[group] =
        static_cast<std::uint8_t>(flatWindows(static_cast<std::size_t>(row), static_cast<std::size_t>(column) / 4 * 4));
  }
  return (windows_flat_[group] >> (column % 4) & 1) != 0;
}

// Whether a window that is flat holds both of two quads (or the only one).
ClothTree::InWindow ClothTree::inFlatWindow(const QuadRectangle& one, const QuadRectangle& other) noexcept {
  const int top = std::min(one.row, other.row), left = std::min(one.column, other.column);
  const int bottom = std::max(one.row, other.row), right = std::max(one.column, other.column);
  if (bottom > top + 1 || right > left + 1) return InWindow::kNone;
  const int first_row = std::max(bottom - 1, 0), last_row = std::min(top, grid_.rows - 3);
  const int first_column = std::max(right - 1, 0), last_column = std::min(left, grid_.linkCount() - 2);
  InWindow found = InWindow::kNone;
  for (int i = first_row; i <= last_row; ++i) {
    for (int j = first_column; j <= last_column; ++j) {
      if (isWindowFlat(i, j)) return InWindow::kFlat;
      found = InWindow::kBent;
    }
  }
  return found;
}

}  // namespace curtain
