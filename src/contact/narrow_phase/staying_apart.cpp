// SPDX-License-Identifier: BSD-3-Clause
#include "contact/narrow_phase/staying_apart.h"

#include "contact/narrow_phase/lanes8.h"

namespace curtain {
namespace {

using Lanes = Eight::Lanes;
using Vectors = Eight::Vectors;

static_assert(kPairsAtOnce == Eight::kCount);

/// The four nodes of eight pairs at one instant.
struct Places {
  Vectors node[4];
};

// At both instants, and summed up over them: half way, twice.
CURTAIN_INTO_WIDE void gather(const std::array<FourNodes, kPairsAtOnce>& pairs, const NodeWays& ways, Places& start,
                              Places& end, Places& half) {
  for (std::size_t n = 0; n < 4; ++n) {
    const auto node_of = [&](std::size_t k) { return pairs[k][n]; };
    Eight::gather(ways.start, node_of, start.node[n]);
    Eight::gather(ways.end, node_of, end.node[n]);
    half.node[n] = start.node[n];
    half.node[n].add(end.node[n]);
  }
}

// A divisor, or something else where it is none. What comes out decides on a direction alone; but no length may be
// built in, or cloth in other units would get other pairs.
CURTAIN_INTO_WIDE void divide(Lanes& value, const Lanes& divisor, const Lanes& other) {
  value /= divisor > 0.0f ? divisor : other;
}

// How far the first `first` nodes are beyond the others along a direction.
CURTAIN_INTO_WIDE void beyond(const Vectors& way, const Places& at, std::size_t first, Lanes& least) {
  Lanes height[4];
  for (std::size_t n = 0; n < 4; ++n) Eight::dot(way, at.node[n], height[n]);
  // From the first node's, whose rounding is that of near things.
  least = height[0];
  if (first == 2) Eight::lower(least, height[1]);
  Lanes most = height[3];
  for (std::size_t n = first; n < 3; ++n) most = height[n] > most ? height[n] : most;
  least -= most;
}

// The reach with what rounding may add: places are off by `rounding` in every component and no further away than the
// cloth is long, and their product with a direction adds three roundings of that; a multiple stands for all.
CURTAIN_INTO_WIDE float certain(float reach, float rounding) { return (reach + 16.0f * rounding) * (1.0f + 1e-5f); }

// Lanes where the elements are further apart along `way` than so much, at both instants.
CURTAIN_INTO_WIDE std::uint32_t separates(const Vectors& way, const Places& start, const Places& end, std::size_t first,
                                          float least) {
  Lanes at_start, at_end, squared;
  beyond(way, start, first, at_start);
  beyond(way, end, first, at_end);
  Eight::lower(at_start, at_end);
  Eight::dot(way, way, squared);
  return Eight::bitsOf((at_start > 0.0f) & (at_start * at_start > (least * least) * squared));
}

// From the closest point of a segment to the point that is at `from` from its start.
CURTAIN_INTO_WIDE void fromSegment(const Vectors& from, const Vectors& segment, Vectors& way) {
  Lanes share, squared;
  Eight::dot(from, segment, share);
  Eight::dot(segment, segment, squared);
  divide(share, squared, Lanes{} + 1.0f);
  Eight::cut(share);
  way = from;
  way.subtract(share, segment);
}

}  // namespace

CURTAIN_WIDE std::uint32_t edgesStayApart(const std::array<FourNodes, kPairsAtOnce>& pairs, const NodeWays& ways,
                                          float reach, float rounding) noexcept {
  Places start, end, half;
  gather(pairs, ways, start, end, half);
  Vectors ab, cd, ca;
  Eight::difference(half.node[1], half.node[0], ab);
  Eight::difference(half.node[3], half.node[2], cd);
  Eight::difference(half.node[0], half.node[2], ca);
  Lanes ab_ab, cd_cd, ab_cd, ca_ab, ca_cd;
  Eight::dot(ab, ab, ab_ab);
  Eight::dot(cd, cd, cd_cd);
  Eight::dot(ab, cd, ab_cd);
  Eight::dot(ca, ab, ca_ab);
  Eight::dot(ca, cd, ca_cd);
  const Lanes one = Lanes{} + 1.0f;
  ab_ab = ab_ab > 0.0f ? ab_ab : one;
  cd_cd = cd_cd > 0.0f ? cd_cd : one;
  // Ericson, Real-Time Collision Detection, 5.1.9.
  const Lanes squares = ab_ab * cd_cd;
  Lanes s = ab_cd * ca_cd - ca_ab * cd_cd;
  divide(s, squares - ab_cd * ab_cd, squares);
  Eight::cut(s);
  Lanes t = (ab_cd * s + ca_cd) / cd_cd;
  Eight::cut(t);
  s = (ab_cd * t - ca_ab) / ab_ab;
  Eight::cut(s);
  Vectors way = ca;
  way.subtract(-s, ab);
  way.subtract(t, cd);
  return separates(way, start, end, 2, certain(reach, rounding));
}

CURTAIN_WIDE std::uint32_t vertexStaysApart(const std::array<FourNodes, kPairsAtOnce>& pairs, const NodeWays& ways,
                                            float reach, float rounding) noexcept {
  Places start, end, half;
  gather(pairs, ways, start, end, half);
  const float least = certain(reach, rounding);
  // Above the face the normal is the way; beside it, the one from the closest point of its edges.
  Vectors ap, ab, ac, up;
  Eight::difference(half.node[0], half.node[1], ap);
  Eight::difference(half.node[2], half.node[1], ab);
  Eight::difference(half.node[3], half.node[1], ac);
  Eight::cross(ab, ac, up);
  Lanes height;
  Eight::dot(up, ap, height);
  const Lanes one = Lanes{} + 1.0f;
  up.scale(height < 0.0f ? -one : one);
  const std::uint32_t above = separates(up, start, end, 1, least);
  if (above == 0xFFU) return above;
  Vectors bp, bc, from_ab, from_ac, from_bc;
  Eight::difference(half.node[0], half.node[2], bp);
  Eight::difference(half.node[3], half.node[2], bc);
  fromSegment(ap, ab, from_ab);
  fromSegment(ap, ac, from_ac);
  fromSegment(bp, bc, from_bc);
  Lanes to_ab, to_ac, to_bc;
  Eight::dot(from_ab, from_ab, to_ab);
  Eight::dot(from_ac, from_ac, to_ac);
  Eight::dot(from_bc, from_bc, to_bc);
  Vectors way;
  const auto ab_first = to_ab < to_ac;
  const auto bc_first = to_bc < (ab_first ? to_ab : to_ac);
  way.x = bc_first ? from_bc.x : (ab_first ? from_ab.x : from_ac.x);
  way.y = bc_first ? from_bc.y : (ab_first ? from_ab.y : from_ac.y);
  way.z = bc_first ? from_bc.z : (ab_first ? from_ab.z : from_ac.z);
  return above | separates(way, start, end, 1, least);
}

}  // namespace curtain
