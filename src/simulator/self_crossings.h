// SPDX-License-Identifier: BSD-3-Clause
//
// Brute-force oracle for intersections of the cloth with itself.
#pragma once

#include <cstdint>

#include "cloth/cloth.h"

namespace curtain {

/// Pairs of an edge and a triangle of the first layer's mesh (quads cut along one diagonal) that intersect and share no
/// node.
std::int64_t countSelfCrossings(const Grid& grid, const Field3& position);

}  // namespace curtain
