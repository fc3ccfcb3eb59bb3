// SPDX-License-Identifier: BSD-3-Clause
#include "contact/narrow_phase/separating_axis.h"

#include "contact/narrow_phase/simd8.h"

namespace curtain {
namespace {

using Lanes = Simd8::Lanes;
using Vectors = Simd8::Vectors;

static_assert(kPairsAtOnce == Simd8::kCount);

// Of Gilbert's method; more separate hardly any more pairs.
constexpr int kGilbertSteps = 6;

/// Points of eight pairs at both instants, and their sum: the positions half way, times two. The first set of a pair
/// comes first.
template <std::size_t kPoints>
struct Motion {
  Vectors start[kPoints], end[kPoints], half[kPoints];

  template <typename NodeOf>
  CURTAIN_INTO_WIDE void gather(std::size_t point, const SweptNodes& swept, const NodeOf& node_of) {
    Simd8::gather(swept.start, node_of, start[point]);
    Simd8::gather(swept.end, node_of, end[point]);
    half[point] = start[point];
    half[point].add(end[point]);
  }
};

CURTAIN_INTO_WIDE void gatherElements(const std::array<FourNodes, kPairsAtOnce>& pairs, const SweptNodes& swept,
                                      Motion<4>& motion) {
  for (std::size_t n = 0; n < 4; ++n) motion.gather(n, swept, [&](std::size_t k) { return pairs[k][n]; });
}

// The other quad first.
CURTAIN_INTO_WIDE void gatherQuads(const std::array<TwoQuads, kPairsAtOnce>& pairs, const SweptNodes& swept,
                                   Motion<8>& motion) {
  for (std::size_t n = 0; n < 4; ++n) {
    motion.gather(n, swept, [&](std::size_t k) { return pairs[k].other[n]; });
    motion.gather(n + 4, swept, [&](std::size_t k) { return pairs[k].one[n]; });
  }
}

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
    most = height > most ? height : most;
  }
  gap -= most;
}

// Lanes where the gap along a direction exceeds `least` at both instants.
template <std::size_t kFirst, std::size_t kPoints>
CURTAIN_INTO_WIDE std::uint32_t separates(const Vectors& direction, const Motion<kPoints>& motion, float least) {
  Lanes at_start, at_end, squared;
  gapAlong<kFirst>(direction, motion.start, at_start);
  gapAlong<kFirst>(direction, motion.end, at_end);
  Simd8::lower(at_start, at_end);
  Simd8::dot(direction, direction, squared);
  return Simd8::bitsOf((at_start > 0.0f) & (at_start * at_start > (least * least) * squared));
}

// The reach plus rounding: coordinates are off by `rounding` each, and the dot product adds three roundings of the same
// size; the factor covers all.
CURTAIN_INTO_WIDE float withRounding(float reach, float rounding) {
  return (reach + 16.0f * rounding) * (1.0f + 1e-5f);
}

// A quotient that only chooses a direction. Where the divisor is 0, `other` has its dimension: a constant would make
// the candidates depend on the unit of length.
CURTAIN_INTO_WIDE void divide(Lanes& value, const Lanes& divisor, const Lanes& other) {
  value /= divisor > 0.0f ? divisor : other;
}

// From the closest point of a segment to the point at `from`, seen from the segment's start.
CURTAIN_INTO_WIDE void fromSegment(const Vectors& from, const Vectors& segment, Vectors& direction) {
  Lanes share, squared;
  Simd8::dot(from, segment, share);
  Simd8::dot(segment, segment, squared);
  divide(share, squared, Lanes{} + 1.0f);
  Simd8::cut(share);
  direction = from;
  direction.subtract(share, segment);
}

// From the first quad's centre to the other's, times eight.
CURTAIN_INTO_WIDE void betweenCentres(const Motion<8>& motion, Vectors& direction) {
  direction = motion.half[0];
  direction.subtract(motion.half[4]);
  for (std::size_t n = 1; n < 4; ++n) {
    direction.add(motion.half[n]);
    direction.subtract(motion.half[n + 4]);
  }
}

// Normal of a quad, on the side of `between`.
CURTAIN_INTO_WIDE void quadNormal(const Vectors* corners, const Vectors& between, Vectors& normal) {
  Vectors falling, rising;
  Simd8::difference(corners[3], corners[0], falling);
  Simd8::difference(corners[1], corners[2], rising);
  Simd8::cross(falling, rising, normal);
  Lanes side;
  Simd8::dot(normal, between, side);
  const Lanes one = Lanes{} + 1.0f;
  normal.scale(side < 0.0f ? -one : one);
}

}  // namespace

CURTAIN_WIDE std::uint32_t edgesSeparated(const std::array<FourNodes, kPairsAtOnce>& pairs, const SweptNodes& swept,
                                          float reach, float rounding) noexcept {
  Motion<4> motion;
  gatherElements(pairs, swept, motion);
  Vectors ab, cd, ca;
  Simd8::difference(motion.half[1], motion.half[0], ab);
  Simd8::difference(motion.half[3], motion.half[2], cd);
  Simd8::difference(motion.half[0], motion.half[2], ca);
  Lanes ab_ab, cd_cd, ab_cd, ca_ab, ca_cd;
  Simd8::dot(ab, ab, ab_ab);
  Simd8::dot(cd, cd, cd_cd);
  Simd8::dot(ab, cd, ab_cd);
  Simd8::dot(ca, ab, ca_ab);
  Simd8::dot(ca, cd, ca_cd);
  const Lanes one = Lanes{} + 1.0f;
  ab_ab = ab_ab > 0.0f ? ab_ab : one;
  cd_cd = cd_cd > 0.0f ? cd_cd : one;
  // Closest points of two segments: Ericson, Real-Time Collision Detection, 5.1.9.
  const Lanes squares = ab_ab * cd_cd;
  Lanes s = ab_cd * ca_cd - ca_ab * cd_cd;
  divide(s, squares - ab_cd * ab_cd, squares);
  Simd8::cut(s);
  Lanes t = (ab_cd * s + ca_cd) / cd_cd;
  Simd8::cut(t);
  s = (ab_cd * t - ca_ab) / ab_ab;
  Simd8::cut(s);
  Vectors direction = ca;
  direction.subtract(-s, ab);
  direction.subtract(t, cd);
  return separates<2>(direction, motion, withRounding(reach, rounding));
}

CURTAIN_WIDE std::uint32_t vertexSeparated(const std::array<FourNodes, kPairsAtOnce>& pairs, const SweptNodes& swept,
                                           float reach, float rounding) noexcept {
  Motion<4> motion;
  gatherElements(pairs, swept, motion);
  const float least = withRounding(reach, rounding);
  // Over the face its normal; beside it the direction from the closest point of its edges.
  Vectors ap, ab, ac, up;
  Simd8::difference(motion.half[0], motion.half[1], ap);
  Simd8::difference(motion.half[2], motion.half[1], ab);
  Simd8::difference(motion.half[3], motion.half[1], ac);
  Simd8::cross(ab, ac, up);
  Lanes height;
  Simd8::dot(up, ap, height);
  const Lanes one = Lanes{} + 1.0f;
  up.scale(height < 0.0f ? -one : one);
  const std::uint32_t above = separates<1>(up, motion, least);
  if (above == 0xFFU) return above;
  Vectors bp, bc, from_ab, from_ac, from_bc;
  Simd8::difference(motion.half[0], motion.half[2], bp);
  Simd8::difference(motion.half[3], motion.half[2], bc);
  fromSegment(ap, ab, from_ab);
  fromSegment(ap, ac, from_ac);
  fromSegment(bp, bc, from_bc);
  Lanes to_ab, to_ac, to_bc;
  Simd8::dot(from_ab, from_ab, to_ab);
  Simd8::dot(from_ac, from_ac, to_ac);
  Simd8::dot(from_bc, from_bc, to_bc);
  Vectors direction;
  const auto ab_first = to_ab < to_ac;
  const auto bc_first = to_bc < (ab_first ? to_ab : to_ac);
  direction.x = bc_first ? from_bc.x : (ab_first ? from_ab.x : from_ac.x);
  direction.y = bc_first ? from_bc.y : (ab_first ? from_ab.y : from_ac.y);
  direction.z = bc_first ? from_bc.z : (ab_first ? from_ab.z : from_ac.z);
  return above | separates<1>(direction, motion, least);
}

CURTAIN_WIDE std::uint32_t quadsSeparated(const std::array<TwoQuads, kPairsAtOnce>& pairs, const SweptNodes& swept,
                                          float reach, float rounding) noexcept {
  Motion<8> motion;
  gatherQuads(pairs, swept, motion);
  const float least = withRounding(reach, rounding);
  Vectors between, normal;
  betweenCentres(motion, between);
  std::uint32_t separated = separates<4>(between, motion, least);
  if (separated == 0xFFU) return separated;
  quadNormal(motion.half + 4, between, normal);
  separated |= separates<4>(normal, motion, least);
  if (separated == 0xFFU) return separated;
  quadNormal(motion.half, between, normal);
  return separated | separates<4>(normal, motion, least);
}

CURTAIN_WIDE std::uint32_t quadsSeparatedByGilbert(const std::array<TwoQuads, kPairsAtOnce>& pairs,
                                                   const SweptNodes& swept, float reach, float rounding) noexcept {
  Motion<8> motion;
  gatherQuads(pairs, swept, motion);
  const float least = withRounding(reach, rounding);
  Vectors direction;
  betweenCentres(motion, direction);
  direction.scale(Lanes{} + 0.25f);
  std::uint32_t separated = 0;
  for (int step = 0; step < kGilbertSteps && separated != 0xFFU; ++step) {
    // Support points: the corner of the first quad furthest along the direction, that of the other least far.
    Vectors nearest = motion.half[0], furthest = motion.half[4];
    Lanes lowest, most;
    Simd8::dot(direction, nearest, lowest);
    Simd8::dot(direction, furthest, most);
    const auto choose = [](const Vectors& corner, const auto& better, Vectors& chosen) {
      chosen.x = better ? corner.x : chosen.x;
      chosen.y = better ? corner.y : chosen.y;
      chosen.z = better ? corner.z : chosen.z;
    };
    for (std::size_t n = 1; n < 4; ++n) {
      Lanes height;
      Simd8::dot(direction, motion.half[n + 4], height);
      choose(motion.half[n + 4], height > most, furthest);
      most = height > most ? height : most;
      Simd8::dot(direction, motion.half[n], height);
      choose(motion.half[n], height < lowest, nearest);
      lowest = height < lowest ? height : lowest;
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
    if (step > 0) separated |= separates<4>(direction, motion, least);
  }
  return separated;
}

}  // namespace curtain
