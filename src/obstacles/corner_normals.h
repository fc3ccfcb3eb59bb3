// SPDX-License-Identifier: BSD-3-Clause
//
// Normals for drawing shapes, which are of flat triangles.
#pragma once

#include <vector>

#include "curtain_sim/obstacle_shape.h"

namespace curtain {

/// Normals at the corners of a shape's triangles: three of each triangle, in its order, unit length. Faces that meet at
/// less than 40 degrees share theirs (round shapes look round), others keep their own (boxes have edges).
std::vector<Vec3> cornerNormals(const ShapeTriangles& shape);

}  // namespace curtain
