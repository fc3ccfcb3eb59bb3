// SPDX-License-Identifier: BSD-3-Clause
#include "contact/narrow_phase/quads_apart.h"

#include "contact/narrow_phase/lanes8.h"

namespace curtain {
namespace {

using Lanes = Eight::Lanes;
using Vectors = Eight::Vectors;

constexpr int kSteps = 6;

/// Corners of eight pairs of quads at one instant.
struct Corners {
  Vectors one[4], other[4];
};

// At both instants, and summed up over them: half way, twice.
CURTAIN_INTO_WIDE void gather(const std::array<TwoQuads, kPairsAtOnce>& pairs, const NodeWays& ways, Corners& start,
                              Corners& end, Corners& half) {
  for (std::size_t n = 0; n < 4; ++n) {
    const auto take = [&](FourNodes TwoQuads::*quad, Vectors(Corners::*corners)[4]) {
      const auto node_of = [&](std::size_t k) { return (pairs[k].*quad)[n]; };
      Eight::gather(ways.start, node_of, (start.*corners)[n]);
      Eight::gather(ways.end, node_of, (end.*corners)[n]);
      (half.*corners)[n] = (start.*corners)[n];
      (half.*corners)[n].add((end.*corners)[n]);
    };
    take(&TwoQuads::one, &Corners::one);
    take(&TwoQuads::other, &Corners::other);
  }
}

// How far the other quads are beyond the first ones along a direction.
CURTAIN_INTO_WIDE void beyond(const Vectors& way, const Corners& at, Lanes& apart) {
  Lanes most, height;
  Eight::dot(way, at.other[0], apart);
  Eight::dot(way, at.one[0], most);
  for (std::size_t n = 1; n < 4; ++n) {
    Eight::dot(way, at.other[n], height);
    Eight::lower(apart, height);
    Eight::dot(way, at.one[n], height);
    most = height > most ? height : most;
  }
  apart -= most;
}

// Lanes where they are further than so much, at both instants.
CURTAIN_INTO_WIDE std::uint32_t separates(const Vectors& way, const Corners& start, const Corners& end, float least) {
  Lanes at_start, at_end, squared;
  beyond(way, start, at_start);
  beyond(way, end, at_end);
  Eight::lower(at_start, at_end);
  Eight::dot(way, way, squared);
  return Eight::bitsOf((at_start > 0.0f) & (at_start * at_start > (least * least) * squared));
}

// Coordinates are rounded, and so are three products and sums of each: a multiple stands for all.
CURTAIN_INTO_WIDE float certain(float reach, float rounding) { return (reach + 16.0f * rounding) * (1.0f + 1e-5f); }

// From the first quads' middles to the others', four times.
CURTAIN_INTO_WIDE void betweenMiddles(const Corners& at, Vectors& way) {
  way = at.other[0];
  way.subtract(at.one[0]);
  for (std::size_t n = 1; n < 4; ++n) {
    way.add(at.other[n]);
    way.subtract(at.one[n]);
  }
}

// Across a quad, on the side of `between`.
CURTAIN_INTO_WIDE void across(const Vectors (&corners)[4], const Vectors& between, Vectors& way) {
  Vectors falling, rising;
  Eight::difference(corners[3], corners[0], falling);
  Eight::difference(corners[1], corners[2], rising);
  Eight::cross(falling, rising, way);
  Lanes side;
  Eight::dot(way, between, side);
  const Lanes one = Lanes{} + 1.0f;
  way.scale(side < 0.0f ? -one : one);
}

}  // namespace

CURTAIN_WIDE std::uint32_t quadsStayApart(const std::array<TwoQuads, kPairsAtOnce>& pairs, const NodeWays& ways,
                                          float reach, float rounding) noexcept {
  Corners start, end, half;
  gather(pairs, ways, start, end, half);
  const float least = certain(reach, rounding);
  Vectors between, way;
  betweenMiddles(half, between);
  std::uint32_t apart = separates(between, start, end, least);
  if (apart == 0xFFU) return apart;
  across(half.one, between, way);
  apart |= separates(way, start, end, least);
  if (apart == 0xFFU) return apart;
  across(half.other, between, way);
  return apart | separates(way, start, end, least);
}

CURTAIN_WIDE std::uint32_t quadsStayApartSomehow(const std::array<TwoQuads, kPairsAtOnce>& pairs, const NodeWays& ways,
                                                 float reach, float rounding) noexcept {
  Corners start, end, half;
  gather(pairs, ways, start, end, half);
  const float least = certain(reach, rounding);
  Vectors way;
  betweenMiddles(half, way);
  way.scale(Lanes{} + 0.25f);
  std::uint32_t apart = 0;
  for (int step = 0; step < kSteps && apart != 0xFFU; ++step) {
    // The corner of the first quad that is furthest along the way, and that of the other which is nearest.
    Vectors furthest = half.one[0], nearest = half.other[0];
    Lanes most, lowest;
    Eight::dot(way, furthest, most);
    Eight::dot(way, nearest, lowest);
    const auto choose = [](const Vectors& corner, const auto& better, Vectors& chosen) {
      chosen.x = better ? corner.x : chosen.x;
      chosen.y = better ? corner.y : chosen.y;
      chosen.z = better ? corner.z : chosen.z;
    };
    for (std::size_t n = 1; n < 4; ++n) {
      Lanes height;
      Eight::dot(way, half.one[n], height);
      choose(half.one[n], height > most, furthest);
      most = height > most ? height : most;
      Eight::dot(way, half.other[n], height);
      choose(half.other[n], height < lowest, nearest);
      lowest = height < lowest ? height : lowest;
    }
    Vectors towards;
    Eight::difference(nearest, furthest, towards);
    towards.subtract(way);
    Lanes share, squared;
    Eight::dot(way, towards, share);
    Eight::dot(towards, towards, squared);
    share = -share / (squared > 0.0f ? squared : Lanes{} + 1.0f);
    Eight::cut(share);
    way.subtract(-share, towards);
    if (step > 0) apart |= separates(way, start, end, least);
  }
  return apart;
}

}  // namespace curtain
