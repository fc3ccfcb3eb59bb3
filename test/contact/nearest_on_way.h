// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "contact/broad_phase/self_candidates.h"
#include "contact/narrow_phase/closest_points.h"
#include "scene/infinity.h"

namespace curtain_test {

/// Least distance of two elements of the cloth on straight ways of its nodes, at five instants [m]; only of pairs that
/// come within reach [m]: infinite where none does.
inline double nearestOnWay(const curtain::ClothPattern& pattern, const curtain::Field3& start,
                           const curtain::Field3& end, double reach) {
  curtain::Candidates near;
  curtain::SelfCandidates(pattern).collect(start, end, reach, near);
  double least = curtain::kInfinity;
  for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const auto at = [&](std::size_t n) { return curtain::Vec3((1.0 - share) * start.at(n) + share * end.at(n)); };
    const auto look = [&](bool edges, std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
      least = std::min(least, curtain::closestPoints(edges, {at(a), at(b), at(c), at(d)}).distance);
    };
    for (const curtain::VertexTriangle& p : near.vertex_triangles)
      look(false, p.vertex, p.triangle[0], p.triangle[1], p.triangle[2]);
    for (const curtain::EdgeEdge& p : near.edge_edges) look(true, p.first[0], p.first[1], p.second[0], p.second[1]);
  }
  return least;
}

}  // namespace curtain_test
