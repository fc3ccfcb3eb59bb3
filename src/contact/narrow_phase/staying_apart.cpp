// SPDX-License-Identifier: BSD-3-Clause
#include "contact/narrow_phase/staying_apart.h"

#include "contact/narrow_phase/lanes.h"

namespace curtain {
namespace {

inline Lanes cut(const Lanes& a) { return lesser(greater(a, Lanes{}), lanesOf(1.0f)); }

/// The four nodes of four pairs at one instant.
using Places = std::array<LaneVectors, 4>;

Places gather(const std::array<FourNodes, 4>& pairs, const NodeWay* ways, Eigen::Array4f NodeWay::*instant) {
  const auto lanes = [](const Eigen::Array4f& place) { return loadLanes(place.data()); };
  Places at;
  for (std::size_t n = 0; n < 4; ++n) {
    const Lanes a = lanes(ways[pairs[0][n]].*instant), b = lanes(ways[pairs[1][n]].*instant);
    const Lanes c = lanes(ways[pairs[2][n]].*instant), d = lanes(ways[pairs[3][n]].*instant);
    at[n].x = Lanes{a[0], b[0], c[0], d[0]};
    at[n].y = Lanes{a[1], b[1], c[1], d[1]};
    at[n].z = Lanes{a[2], b[2], c[2], d[2]};
  }
  return at;
}

// A divisor, or something else where it is none. What comes out decides on a direction alone; but no length may be built
// in, or cloth in other units would get other pairs.
inline Lanes orElse(const Lanes& divisor, const Lanes& other) { return divisor > 0.0f ? divisor : other; }

// How far the first edge is beyond the second along a direction, at one instant.
inline Lanes edgeBeyond(const LaneVectors& way, const Places& at) {
  return lesser(lesser(dot(way, at[0] - at[2]), dot(way, at[0] - at[3])),
                lesser(dot(way, at[1] - at[2]), dot(way, at[1] - at[3])));
}

// The same of a vertex and a triangle.
inline Lanes vertexBeyond(const LaneVectors& way, const Places& at) {
  return lesser(dot(way, at[0] - at[1]), lesser(dot(way, at[0] - at[2]), dot(way, at[0] - at[3])));
}

// From the closest point of a segment to the point that is at `from` from its start.
inline LaneVectors fromSegment(const LaneVectors& from, const LaneVectors& segment) {
  return from - cut(dot(from, segment) / orElse(dot(segment, segment), lanesOf(1.0f))) * segment;
}

// The reach with what rounding may add: differences of places are off by `rounding` in every component and no longer
// than the cloth, and their product with a direction adds three roundings of that; a multiple stands for all.
inline float certain(float reach, float rounding) { return (reach + 8.0f * rounding) * (1.0f + 1e-5f); }

// Lanes where `least` exceeds the length of `way` times `beyond`.
inline std::uint32_t exceeding(const Lanes& least, const LaneVectors& way, float beyond) {
  const Lanes limit = dot(way, way) * (beyond * beyond), squared = least * least;
  std::uint32_t lanes = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    // A value of its own: g++ 12 reads an unset index where UBSan watches both the shift and the lanes of its operand.
    const bool exceeds = least[k] > 0.0f && squared[k] > limit[k];
    lanes |= static_cast<std::uint32_t>(exceeds) << k;
  }
  return lanes;
}

}  // namespace

std::uint32_t edgesStayApart(const std::array<FourNodes, 4>& pairs, const NodeWay* ways, float reach,
                             float rounding) noexcept {
  const Places start = gather(pairs, ways, &NodeWay::start), end = gather(pairs, ways, &NodeWay::end);
  const LaneVectors a = start[0] + end[0], c = start[2] + end[2];
  const LaneVectors ab = start[1] + end[1] - a, cd = start[3] + end[3] - c, ca = a - c;
  const Lanes ab_ab = orElse(dot(ab, ab), lanesOf(1.0f)), cd_cd = orElse(dot(cd, cd), lanesOf(1.0f));
  const Lanes ab_cd = dot(ab, cd), ca_ab = dot(ca, ab), ca_cd = dot(ca, cd);
  // Ericson, Real-Time Collision Detection, 5.1.9.
  const Lanes squares = ab_ab * cd_cd;
  const Lanes s = cut((ab_cd * ca_cd - ca_ab * cd_cd) / orElse(squares - ab_cd * ab_cd, squares));
  const Lanes t = cut((ab_cd * s + ca_cd) / cd_cd);
  const LaneVectors way = ca + cut((ab_cd * t - ca_ab) / ab_ab) * ab - t * cd;
  return exceeding(lesser(edgeBeyond(way, start), edgeBeyond(way, end)), way, certain(reach, rounding));
}

std::uint32_t vertexStaysApart(const std::array<FourNodes, 4>& pairs, const NodeWay* ways, float reach,
                               float rounding) noexcept {
  const Places start = gather(pairs, ways, &NodeWay::start), end = gather(pairs, ways, &NodeWay::end);
  const float beyond = certain(reach, rounding);
  const LaneVectors p = start[0] + end[0], a = start[1] + end[1], b = start[2] + end[2], c = start[3] + end[3];
  const LaneVectors ap = p - a, ab = b - a, ac = c - a;
  // Above the face the normal is the way; beside it, the one from the closest point of its edges.
  const LaneVectors normal = cross(ab, ac);
  const LaneVectors up = (dot(normal, ap) < 0.0f ? lanesOf(-1.0f) : lanesOf(1.0f)) * normal;
  const std::uint32_t above = exceeding(lesser(vertexBeyond(up, start), vertexBeyond(up, end)), up, beyond);
  if (above == 0xFU) return above;
  const LaneVectors from_ab = fromSegment(ap, ab), from_ac = fromSegment(ap, ac), from_bc = fromSegment(p - b, c - b);
  const Lanes to_ab = dot(from_ab, from_ab), to_ac = dot(from_ac, from_ac), to_bc = dot(from_bc, from_bc);
  const auto ab_first = to_ab < to_ac;
  const auto bc_first = to_bc < lesser(to_ab, to_ac);
  const LaneVectors way{bc_first ? from_bc.x : ab_first ? from_ab.x : from_ac.x,
                    bc_first ? from_bc.y : ab_first ? from_ab.y : from_ac.y,
                    bc_first ? from_bc.z : ab_first ? from_ab.z : from_ac.z};
  return above | exceeding(lesser(vertexBeyond(way, start), vertexBeyond(way, end)), way, beyond);
}

}  // namespace curtain
