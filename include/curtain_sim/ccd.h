// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 3: continuous collision detection (CCD) of the pairs a surface of triangles is made of, for straight motion of
// their corners over a step. Never a miss: every rejection is certain with all roundings counted, and what can't be
// told is an impact.
//
//   p *            t = 0          the time of impact is the first t at which the distance is <= min_distance
//      \     b
//    a  \  .-'|                   p(t) = p0 + t (p1 - p0), and so for every corner
//     '. \'   |
//       '.\   |
//         '*--c    t = 1
#pragma once

#include <optional>

#include "curtain_sim/scene.h"

namespace curtain {

/// When the vertex p meets the triangle (a, b, c), both sides count.
///   p0, a0, b0, c0   where they are at t = 0 [m]; triangles without area count as their edges or point
///   p1, a1, b1, c1   where they are at t = 1 [m]
///   min_distance     [m], less than zero counts as zero
/// Returns a time in [0..1] that is never later than the first time at which the distance is <= min_distance (0.0: they
/// are that close at the start); none: certainly no such time. At the told time the distance is above min_distance by
/// no more than some 1e-14 of the largest distance between corners of the two, so a miss by less may be told as an
/// impact, and for two that slide along each other that closely the time may be early by much. Input that is not
/// finite, or beyond
/// 1e75 m, gives 0.0. Bounded work (100 steps, an impact beyond), no allocation; thread-safe; the same bits on every
/// machine.
std::optional<double> vertexTriangleTimeOfImpact(const Vec3& p0, const Vec3& a0, const Vec3& b0, const Vec3& c0,
                                                 const Vec3& p1, const Vec3& a1, const Vec3& b1, const Vec3& c1,
                                                 double min_distance = 0.0) noexcept;

/// When the edges a-b and c-d meet; as above, edges without length count as their point.
std::optional<double> edgeEdgeTimeOfImpact(const Vec3& a0, const Vec3& b0, const Vec3& c0, const Vec3& d0,
                                           const Vec3& a1, const Vec3& b1, const Vec3& c1, const Vec3& d1,
                                           double min_distance = 0.0) noexcept;

}  // namespace curtain
