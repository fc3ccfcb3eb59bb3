// SPDX-License-Identifier: BSD-3-Clause
//
// Brute-force oracle for intersections of the cloth with itself.
#pragma once

#include <cstdint>
#include <vector>

#include "cloth/coarse_mesh.h"

namespace curtain {

/// An edge and a triangle that intersect and share no node.
struct SelfCrossing {
  MeshEdge edge;
  MeshTriangle triangle;
};

/// All of the first layer's mesh (quads cut along one diagonal).
std::vector<SelfCrossing> findSelfCrossings(const Grid& grid, const Field3& position);

inline std::int64_t countSelfCrossings(const Grid& grid, const Field3& position) {
  return static_cast<std::int64_t>(findSelfCrossings(grid, position).size());
}

}  // namespace curtain
