// SPDX-License-Identifier: BSD-3-Clause
#include "contact/narrow_phase/flatness.h"

#include <algorithm>

#include "contact/narrow_phase/simd8.h"

namespace curtain {
namespace {

using Lanes = Simd8::Lanes;
using Vectors = Simd8::Vectors;

constexpr float kMinSine = 0.01f;        // of the angle between the mean slopes, squared
constexpr float kMinSlope = 1e-4f;       // of the mean slopes, squared
constexpr float kRoundedSlopes = 2e-5f;  // rounding of U, V, a, b, on lambda
constexpr float kTiny = 1e-20f;

CURTAIN_INTO_WIDE void makeUnit(const Lanes& square, Vectors& vector) {
  Lanes per_root;
  Simd8::inverseRoot(square + kTiny, per_root);
  vector.scale(per_root);
}

// The directions a and b from the mean slopes (of any scale); returns where there are some.
CURTAIN_INTO_WIDE std::uint32_t findDirections(Vectors mean_u, Vectors mean_v, Vectors& a, Vectors& b) {
  Lanes square_u, square_v, cosine;
  Simd8::dot(mean_u, mean_u, square_u);
  Simd8::dot(mean_v, mean_v, square_v);
  makeUnit(square_u, mean_u);
  makeUnit(square_v, mean_v);
  Simd8::dot(mean_u, mean_v, cosine);
  const Lanes plus = 1.0f + cosine, minus = 1.0f - cosine;
  Lanes per_plus, per_minus;
  Simd8::inverseRoot(plus > kTiny ? plus : Lanes{} + kTiny, per_plus);
  Simd8::inverseRoot(minus > kTiny ? minus : Lanes{} + kTiny, per_minus);
  per_plus *= 0.5f;
  per_minus *= 0.5f;
  a = {(mean_u.x + mean_v.x) * per_plus, (mean_u.y + mean_v.y) * per_plus, (mean_u.z + mean_v.z) * per_plus};
  const Vectors skew{(mean_u.x - mean_v.x) * per_minus, (mean_u.y - mean_v.y) * per_minus,
                     (mean_u.z - mean_v.z) * per_minus};
  b = {a.x - skew.x, a.y - skew.y, a.z - skew.z};
  a.add(skew);
  return Simd8::bitsOf(((plus < minus ? plus : minus) > kMinSine) &
                       ((square_u < square_v ? square_u : square_v) > kMinSlope));
}

// Bound for lambda: reach over the least altitude of a triangle, plus rounding of the slopes by a few ulps of the
// largest coordinate over the spacing.
CURTAIN_INTO_WIDE void findLimit(const FlatNodes& nodes, const Lanes& max_u, float max_v, Lanes& limit) {
  const Lanes squares = max_u * max_u + max_v * max_v;
  Simd8::inverseRoot(squares, limit);
  limit = (1.0f + 1e-4f) *
              (nodes.reach * (squares * limit) + (16.0f * nodes.rounding) * (max_u > max_v ? max_u : Lanes{} + max_v)) +
          kRoundedSlopes;
}

// Lanes of `flat` stay where both eigenvalues of the symmetric part of J exceed the limit.
template <typename Truth>
CURTAIN_INTO_WIDE void narrow(const Lanes& along_u, const Lanes& across_u, const Lanes& along_v, const Lanes& across_v,
                              const Lanes& limit, Truth& flat) {
  const Lanes u = along_u - limit, v = along_v - limit, across = 0.5f * (across_u + across_v);
  flat &= (u > 0.0f) & (v > 0.0f) & (u * v > across * across);
}

// Lanes of windows that keep `limit` along a and b.
template <int wide>
CURTAIN_INTO_WIDE std::uint32_t findFlat(const FlatNodes& nodes, int high, const Vectors& a, const Vectors& b,
                                         const Lanes& limit) {
  auto flat = limit > 0.0f;
  for (const auto& places : nodes.places) {
    // Components of a row of nodes, and of the one above.
    Lanes row_a[wide + 1], row_b[wide + 1], above_a[wide + 1], above_b[wide + 1];
    for (int i = 0; i <= high; ++i) {
      for (int j = 0; j <= wide; ++j) {
        const std::size_t node = static_cast<std::size_t>(i) * nodes.stride + static_cast<std::size_t>(j);
        Vectors at;
        Simd8::load(places[0] + node, at.x);
        Simd8::load(places[1] + node, at.y);
        Simd8::load(places[2] + node, at.z);
        Simd8::dot(at, a, row_a[j]);
        Simd8::dot(at, b, row_b[j]);
      }
      if (i > 0) {
        const Lanes per_v = Lanes{} + nodes.per_spacing_v[i - 1];
        for (int j = 0; j < wide; ++j) {
          Lanes per_u;
          Simd8::load(nodes.per_spacing_u + j, per_u);
          narrow((above_a[j + 1] - above_a[j]) * per_u, (above_b[j + 1] - above_b[j]) * per_u,
                 (row_b[j] - above_b[j]) * per_v, (row_a[j] - above_a[j]) * per_v, limit, flat);
          narrow((row_a[j + 1] - row_a[j]) * per_u, (row_b[j + 1] - row_b[j]) * per_u,
                 (row_b[j + 1] - above_b[j + 1]) * per_v, (row_a[j + 1] - above_a[j + 1]) * per_v, limit, flat);
        }
      }
      for (int j = 0; j <= wide; ++j) {
        above_a[j] = row_a[j];
        above_b[j] = row_b[j];
      }
    }
  }
  return Simd8::bitsOf(flat);
}

// The slopes' directions are those between the corners.
template <int wide>
CURTAIN_INTO_WIDE std::uint32_t findFlatWindows(const FlatNodes& nodes, int high) {
  Vectors mean_u{}, mean_v{}, a, b;
  const std::size_t below = static_cast<std::size_t>(high) * nodes.stride;
  for (const auto& places : nodes.places) {
    const auto slopes = [&](const float* at, Lanes& u, Lanes& v) {
      Lanes first, right, lower, last;
      Simd8::load(at, first);
      Simd8::load(at + wide, right);
      Simd8::load(at + below, lower);
      Simd8::load(at + below + wide, last);
      const Lanes falling = last - first, rising = right - lower;
      u += falling + rising;
      v += falling - rising;
    };
    slopes(places[0], mean_u.x, mean_v.x);
    slopes(places[1], mean_u.y, mean_v.y);
    slopes(places[2], mean_u.z, mean_v.z);
  }
  Lanes max_u, limit;
  Simd8::load(nodes.per_spacing_u, max_u);
  if (wide == 2) {
    Lanes other;
    Simd8::load(nodes.per_spacing_u + 1, other);
    Simd8::raise(max_u, other);
  }
  findLimit(nodes, max_u, *std::max_element(nodes.per_spacing_v, nodes.per_spacing_v + high), limit);
  const std::uint32_t found = findDirections(mean_u, mean_v, a, b);
  return found & findFlat<wide>(nodes, high, a, b, limit);
}

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

CURTAIN_WIDE std::uint32_t flatWindows(const FlatNodes& nodes, int high, int wide) noexcept {
  return wide == 2 ? findFlatWindows<2>(nodes, high) : findFlatWindows<1>(nodes, high);
}

}  // namespace curtain
