// SPDX-License-Identifier: BSD-3-Clause
#include "contact/narrow_phase/separating_axis.h"

#include "contact/narrow_phase/simd8.h"

namespace curtain {
namespace {

using Lanes = Simd8::Lanes;
using Vectors = Simd8::Vectors;

static_assert(kPairsAtOnce == Simd8::kCount);

/// Points of eight pairs at both instants, those of the first set of each pair first.
template <std::size_t kPoints>
struct SweptPoints {
  Vectors start[kPoints], end[kPoints];

  /// node_of(k): of the k-th pair.
  template <typename NodeOf>
  CURTAIN_INTO_WIDE void gather(std::size_t point, const NodeOf& node_of) {
    const SweptNode* nodes[kPairsAtOnce];
    for (std::size_t k = 0; k < kPairsAtOnce; ++k) nodes[k] = node_of(k);
    Simd8::gather([&](std::size_t k) { return nodes[k]->start.data(); }, start[point]);
    Simd8::gather([&](std::size_t k) { return nodes[k]->end.data(); }, end[point]);
  }
  /// Half way, times two.
  CURTAIN_INTO_WIDE void halfWay(Vectors (&half)[kPoints]) const {
    for (std::size_t n = 0; n < kPoints; ++n) {
      half[n] = start[n];
      half[n].add(end[n]);
    }
  }
};

// Gap along a direction: least projection of the first kFirst points less the largest of the others.
template <std::size_t kFirst, std::size_t kPoints>
CURTAIN_INTO_WIDE void gapAlong(const Vectors& direction, const Vectors (&points)[kPoints], Lanes& gap) {
  Lanes most, height;
  Simd8::dot(direction, points[0], gap);
  for (std::size_t n = 1; n < kFirst; ++n) {
    Simd8::dot(direction, points[n], height);
    Simd8::lower(gap, height);
  }
  Simd8::dot(direction, points[kFirst], most);
  for (std::size_t n = kFirst + 1; n < kPoints; ++n) {
    Simd8::dot(direction, points[n], height);
    Simd8::raise(most, height);
  }
  gap -= most;
}

// Lanes where the gap along a direction exceeds `least` at both instants.
template <std::size_t kFirst, std::size_t kPoints>
CURTAIN_INTO_WIDE std::uint32_t separates(const Vectors& direction, const SweptPoints<kPoints>& points, float least) {
  Lanes gap, at_end, squared;
  gapAlong<kFirst>(direction, points.start, gap);
  gapAlong<kFirst>(direction, points.end, at_end);
  Simd8::lower(gap, at_end);
  Simd8::dot(direction, direction, squared);
  return Simd8::bitsOf((gap > 0.0f) & (gap * gap > (least * least) * squared));
}

// The reach plus rounding: coordinates are off by `rounding` each, and the dot product adds three roundings of the same
// size; the factor covers all.
CURTAIN_INTO_WIDE float withRounding(const StraightMotion& motion) {
  return (motion.reach + 16.0f * motion.rounding) * (1.0f + 1e-5f);
}

// A quotient that only chooses a direction. Where the divisor is 0, `other` has its dimension: a constant would make
// the candidates depend on the unit of length.
CURTAIN_INTO_WIDE void divide(Lanes& value, const Lanes& divisor, const Lanes& other) {
  value /= divisor > 0.0f ? divisor : other;
}

// From the closest point of a segment to the point at `from`, seen from the segment's start; and its squared length.
CURTAIN_INTO_WIDE void fromSegment(const Vectors& from, const Vectors& segment, Vectors& direction, Lanes& square) {
  Lanes share, squared;
  Simd8::dot(from, segment, share);
  Simd8::dot(segment, segment, squared);
  divide(share, squared, Lanes{} + 1.0f);
  Simd8::cut(share);
  direction = from;
  direction.subtract(share, segment);
  Simd8::dot(direction, direction, square);
}

struct Edges {
  static constexpr std::size_t kFirst = 2;

  // Between the closest points of two segments: Ericson, Real-Time Collision Detection, 5.1.9.
  static CURTAIN_INTO_WIDE void direction(const Vectors (&at)[4], Vectors& to) {
    Vectors ab, cd, ca;
    Simd8::difference(at[1], at[0], ab);
    Simd8::difference(at[3], at[2], cd);
    Simd8::difference(at[0], at[2], ca);
    Lanes ab_ab, cd_cd, ab_cd, ca_ab, ca_cd;
    Simd8::dot(ab, ab, ab_ab);
    Simd8::dot(cd, cd, cd_cd);
    Simd8::dot(ab, cd, ab_cd);
    Simd8::dot(ca, ab, ca_ab);
    Simd8::dot(ca, cd, ca_cd);
    const Lanes one = Lanes{} + 1.0f;
    ab_ab = ab_ab > 0.0f ? ab_ab : one;
    cd_cd = cd_cd > 0.0f ? cd_cd : one;
    const Lanes squares = ab_ab * cd_cd;
    Lanes s = ab_cd * ca_cd - ca_ab * cd_cd;
    divide(s, squares - ab_cd * ab_cd, squares);
    Simd8::cut(s);
    Lanes t = (ab_cd * s + ca_cd) / cd_cd;
    Simd8::cut(t);
    s = (ab_cd * t - ca_ab) / ab_ab;
    Simd8::cut(s);
    to = ca;
    to.subtract(-s, ab);
    to.subtract(t, cd);
  }
};

struct VertexAndTriangle {
  static constexpr std::size_t kFirst = 1;

  // Over the face its normal, on the vertex's side; beside it from the closest point of its edges.
  static CURTAIN_INTO_WIDE void direction(const Vectors (&at)[4], Vectors& to) {
    Vectors ap, ab, ac, bp, bc, across;
    Simd8::difference(at[0], at[1], ap);
    Simd8::difference(at[2], at[1], ab);
    Simd8::difference(at[3], at[1], ac);
    Simd8::difference(at[0], at[2], bp);
    Simd8::difference(at[3], at[2], bc);
    Vectors normal, from_ab, from_ac, from_bc;
    Simd8::cross(ab, ac, normal);
    Lanes over_ab, over_ac, over_bc, height, to_ab, to_ac, to_bc;
    Simd8::cross(ab, ap, across);
    Simd8::dot(across, normal, over_ab);
    Simd8::cross(ap, ac, across);
    Simd8::dot(across, normal, over_ac);
    Simd8::cross(bc, bp, across);
    Simd8::dot(across, normal, over_bc);
    Simd8::dot(normal, ap, height);
    normal.scale(height < 0.0f ? Lanes{} - 1.0f : Lanes{} + 1.0f);
    fromSegment(ap, ab, from_ab, to_ab);
    fromSegment(ap, ac, from_ac, to_ac);
    fromSegment(bp, bc, from_bc, to_bc);
    to = from_ab;
    Simd8::choose(to_ac < to_ab, from_ac, to);
    Simd8::lower(to_ab, to_ac);
    Simd8::choose(to_bc < to_ab, from_bc, to);
    Simd8::choose((over_ab >= 0.0f) & (over_ac >= 0.0f) & (over_bc >= 0.0f), normal, to);
  }
};

template <typename Elements>
CURTAIN_INTO_WIDE void findNear(const SweptPoints<Clusters::kMost>& all, const std::vector<LocalPair>& pairs,
                                float least, std::uint8_t* near) {
  for (std::size_t l = 0; l < pairs.size(); ++l) {
    SweptPoints<4> points;
    for (std::size_t n = 0; n < 4; ++n) {
      points.start[n] = all.start[pairs[l][n]];
      points.end[n] = all.end[pairs[l][n]];
    }
    Vectors half[4], direction;
    points.halfWay(half);
    Elements::direction(half, direction);
    near[l] = static_cast<std::uint8_t>(~separates<Elements::kFirst>(direction, points, least));
  }
}

}  // namespace

CURTAIN_WIDE void findNear(const Clusters& clusters, const StraightMotion& motion,
                           const std::vector<LocalPair>& vertices, const std::vector<LocalPair>& edges,
                           std::uint8_t* near) noexcept {
  SweptPoints<Clusters::kMost> points;
  for (std::size_t n = 0; n < clusters.size; ++n)
    points.gather(n, [&](std::size_t k) { return motion.nodes + clusters.nodes[n][k]; });
  const float least = withRounding(motion);
  findNear<VertexAndTriangle>(points, vertices, least, near);
  findNear<Edges>(points, edges, least, near + vertices.size());
}

CURTAIN_WIDE std::uint32_t quadsSeparated(const std::array<TwoQuads, kPairsAtOnce>& pairs, const StraightMotion& motion,
                                          std::size_t stride, int steps) noexcept {
  SweptPoints<8> points;
  for (std::size_t n = 0; n < 4; ++n) {
    const SweptNode* const corner = motion.nodes + n % 2 + n / 2 * stride;
    points.gather(n, [&](std::size_t k) { return corner + pairs[k].one; });
    points.gather(n + 4, [&](std::size_t k) { return corner + pairs[k].other; });
  }
  const float least = withRounding(motion);
  Vectors half[8], direction{};
  points.halfWay(half);
  for (std::size_t n = 0; n < 4; ++n) {
    direction.add(half[n]);
    direction.subtract(half[n + 4]);
  }
  direction.scale(Lanes{} + 0.25f);
  std::uint32_t separated = separates<4>(direction, points, least);
  for (int step = 0; step < steps && separated != 0xFFU; ++step) {
    // Support points: the corner of the first quad least far along the direction, that of the other furthest.
    Vectors nearest = half[0], furthest = half[4];
    Lanes lowest, most;
    Simd8::dot(direction, nearest, lowest);
    Simd8::dot(direction, furthest, most);
    for (std::size_t n = 1; n < 4; ++n) {
      Lanes height;
      Simd8::dot(direction, half[n], height);
      Simd8::choose(height < lowest, half[n], nearest);
      Simd8::lower(lowest, height);
      Simd8::dot(direction, half[n + 4], height);
      Simd8::choose(height > most, half[n + 4], furthest);
      Simd8::raise(most, height);
    }
    Vectors towards;
    Simd8::difference(nearest, furthest, towards);
    towards.subtract(direction);
    Lanes share, squared;
    Simd8::dot(direction, towards, share);
    Simd8::dot(towards, towards, squared);
    share = -share / (squared > 0.0f ? squared : Lanes{} + 1.0f);
    Simd8::cut(share);
    direction.subtract(-share, towards);
    separated |= separates<4>(direction, points, least);
  }
  return separated;
}

}  // namespace curtain
