// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 3: continuous collision detection (CCD) of vertex-triangle and edge-edge pairs, for straight motion of their
// corners over a step. Conservative: rounding is bounded, a rejection is certain, and what can't be decided is an
// impact.
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

/// Time of impact of the vertex p and the triangle (a, b, c), from either side.
///   p0, a0, b0, c0   positions at t = 0 [m]; triangles without area count as their edges or point
///   p1, a1, b1, c1   positions at t = 1 [m]
///   min_distance     [m], less than zero counts as zero
/// Returns a time in [0..1] no later than the first at which the distance is <= min_distance (0.0: at the start); none:
/// certainly no such time. At the returned time the distance exceeds min_distance by at most about 1e-14 of the largest
/// distance between corners, so a miss by less may be an impact, and for pairs that slide along each other that closely
/// the time may be much too early. Input that is not finite, or beyond 1e75 m, gives 0.0. Bounded work (100 steps; then
/// an impact), no allocation; thread-safe; the same bits on every machine.
std::optional<double> vertexTriangleTimeOfImpact(const Vec3& p0, const Vec3& a0, const Vec3& b0, const Vec3& c0,
                                                 const Vec3& p1, const Vec3& a1, const Vec3& b1, const Vec3& c1,
                                                 double min_distance = 0.0) noexcept;

/// Time of impact of the edges a-b and c-d; as above, edges without length count as their point.
std::optional<double> edgeEdgeTimeOfImpact(const Vec3& a0, const Vec3& b0, const Vec3& c0, const Vec3& d0,
                                           const Vec3& a1, const Vec3& b1, const Vec3& c1, const Vec3& d1,
                                           double min_distance = 0.0) noexcept;

}  // namespace curtain
