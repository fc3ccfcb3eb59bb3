// SPDX-License-Identifier: BSD-3-Clause
#include "contact/narrow_phase/flatness.h"

#include "contact/narrow_phase/simd8.h"

namespace curtain {
namespace {

using Lanes = Simd8::Lanes;
using Vectors = Simd8::Vectors;

static_assert(FlatWindows::kCount == Simd8::kCount);

template <int high, int wide>
CURTAIN_INTO_WIDE std::uint32_t findFlat(const FlatWindows& windows) {
  constexpr float kLeastSine = 0.01f;      // of the angle between the mean slopes, squared
  constexpr float kLeastSlope = 1e-4f;     // of the mean slopes, squared
  constexpr float kRoundedSlopes = 2e-5f;  // rounding of U, V, a, b, on lambda
  constexpr float kTiny = 1e-20f;
  Vectors u[2][3][2], v[2][2][3];
  Vectors mean_u{}, mean_v{};
  Lanes most_u{};
  float most_v = 0.0f;
  for (int n = 0; n < 2; ++n) {
    Vectors at[3][3];
    for (int i = 0; i <= high; ++i) {
      for (int j = 0; j <= wide; ++j) {
        const std::size_t node = static_cast<std::size_t>(i) * windows.stride + static_cast<std::size_t>(j);
        Simd8::load(windows.places[n][0] + node, at[i][j].x);
        Simd8::load(windows.places[n][1] + node, at[i][j].y);
        Simd8::load(windows.places[n][2] + node, at[i][j].z);
      }
    }
    const auto slope = [](const Vectors& from, const Vectors& to, const Lanes& per, Vectors& out) {
      out = {to.x - from.x, to.y - from.y, to.z - from.z};
      out.scale(per);
    };
    for (int j = 0; j < wide; ++j) {
      Lanes per;
      Simd8::load(windows.per_spacing_u + j, per);
      most_u = most_u > per ? most_u : per;
      for (int i = 0; i <= high; ++i) {
        slope(at[i][j], at[i][j + 1], per, u[n][i][j]);
        mean_u.add(u[n][i][j]);
      }
    }
    for (int i = 0; i < high; ++i) {
      const Lanes per = Lanes{} + windows.per_spacing_v[i];
      most_v = most_v > windows.per_spacing_v[i] ? most_v : windows.per_spacing_v[i];
      for (int j = 0; j <= wide; ++j) {
        slope(at[i][j], at[i + 1][j], per, v[n][i][j]);
        mean_v.add(v[n][i][j]);
      }
    }
  }
  Lanes square_u, square_v, cosine, per_root;
  Simd8::dot(mean_u, mean_u, square_u);
  Simd8::dot(mean_v, mean_v, square_v);
  Simd8::inverseRoot(square_u + kTiny, per_root);
  mean_u.scale(per_root);
  Simd8::inverseRoot(square_v + kTiny, per_root);
  mean_v.scale(per_root);
  Simd8::dot(mean_u, mean_v, cosine);
  const Lanes plus = 1.0f + cosine, minus = 1.0f - cosine;
  Lanes per_plus, per_minus;
  Simd8::inverseRoot(plus > kTiny ? plus : Lanes{} + kTiny, per_plus);
  Simd8::inverseRoot(minus > kTiny ? minus : Lanes{} + kTiny, per_minus);
  per_plus *= 0.5f;
  per_minus *= 0.5f;
  Vectors a{(mean_u.x + mean_v.x) * per_plus, (mean_u.y + mean_v.y) * per_plus, (mean_u.z + mean_v.z) * per_plus};
  const Vectors skew{(mean_u.x - mean_v.x) * per_minus, (mean_u.y - mean_v.y) * per_minus,
                     (mean_u.z - mean_v.z) * per_minus};
  const Vectors b{a.x - skew.x, a.y - skew.y, a.z - skew.z};
  a.add(skew);
  // Bound for lambda: reach over the least altitude of a triangle, plus rounding of the slopes by a few ulps of the
  // largest coordinate over the spacing.
  Lanes limit;
  const Lanes squares = most_u * most_u + most_v * most_v;
  Simd8::inverseRoot(squares, limit);
  limit = (1.0f + 1e-4f) * (windows.reach * (squares * limit) +
                            (16.0f * windows.rounding) * (most_u > most_v ? most_u : Lanes{} + most_v)) +
          kRoundedSlopes;
  auto flat =
      ((plus < minus ? plus : minus) > kLeastSine) & ((square_u < square_v ? square_u : square_v) > kLeastSlope);
  // Both eigenvalues of the symmetric part of J exceed the limit.
  const auto narrow = [&](const Vectors& du, const Vectors& dv) {
    Lanes along_u, along_v, across_u, across_v;
    Simd8::dot(du, a, along_u);
    Simd8::dot(dv, b, along_v);
    Simd8::dot(du, b, across_u);
    Simd8::dot(dv, a, across_v);
    along_u -= limit;
    along_v -= limit;
    const Lanes across = 0.5f * (across_u + across_v);
    flat &= (along_u > 0.0f) & (along_v > 0.0f) & (along_u * along_v > across * across);
  };
  for (int n = 0; n < 2; ++n) {
    for (int i = 0; i < high; ++i) {
      for (int j = 0; j < wide; ++j) {
        narrow(u[n][i][j], v[n][i][j]);
        narrow(u[n][i + 1][j], v[n][i][j + 1]);
      }
    }
  }
  return Simd8::bitsOf(flat);
}

CURTAIN_WIDE std::uint32_t findFlatSquares(const FlatWindows& windows) { return findFlat<2, 2>(windows); }

}  // namespace

Spacings::Spacings(const ClothPattern& pattern) {
  const Grid& grid = pattern.grid;
  const int quads = grid.linkCount();
  u.assign(static_cast<std::size_t>(Grid::strideFor(grid.columns + 2)) + 2 * Simd8::kCount, 1.0f);
  v.assign(static_cast<std::size_t>(grid.rows), 1.0f);
  for (int j = 0; j < quads + (grid.closed ? 1 : 0); ++j) {
    double sum = 0.0;
    for (int i = 0; i < grid.rows; ++i) sum += pattern.weft_rest[grid.index(i, (j % quads + 1) % grid.columns)];
    u[static_cast<std::size_t>(j)] = static_cast<float>(grid.rows / sum);
  }
  for (int i = 0; i + 1 < grid.rows; ++i) {
    double sum = 0.0;
    for (int j = 0; j < grid.columns; ++j) sum += pattern.warp_rest[grid.index(i + 1, j)];
    v[static_cast<std::size_t>(i)] = static_cast<float>(grid.columns / sum);
  }
}

std::uint32_t FlatWindows::find() const noexcept {
  if (high == 2 && wide == 2) return findFlatSquares(*this);
  if (high == 2) return findFlat<2, 1>(*this);
  return wide == 2 ? findFlat<1, 2>(*this) : findFlat<1, 1>(*this);
}

}  // namespace curtain
