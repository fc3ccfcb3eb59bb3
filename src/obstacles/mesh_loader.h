// SPDX-License-Identifier: BSD-3-Clause
//
// Reads mesh files (STL, OBJ, DAE) by assimp. Its output is checked here: it passes on NaN, triangles without area and
// files without triangles.
#pragma once

#include <string>

#include "curtain_sim/obstacle_shape.h"

namespace curtain {

/// Reads a mesh file: all parts in their poses, polygons triangulated, equal corners shared.
///   path      in the file system
///   scale     factor to metres per axis, each != 0; a mirrored mesh keeps its outside
///   obstacle  name for messages
/// Opens no other file, whatever this one refers to (materials). Limits: 256 MiB, 4 million triangles, polygons of 1000
/// corners; DAE: elements nested 100 deep, 100000 nodes. The unit of a DAE file is applied, its up axis is not (as in
/// rviz). Throws std::invalid_argument "obstacle 'NAME': mesh 'PATH' REASON": missing, unreadable, without triangles,
/// without area, not finite.
ShapeTriangles loadMesh(const std::string& path, const Vec3& scale, const std::string& obstacle);

/// The same of an obstacle of shape mesh, with its URL and scale. Throws the same for a URL that can't be resolved.
ShapeTriangles loadMesh(const ObstacleParams& obstacle, const MeshResolver& resolve = resolveMeshUrl);

/// Nodes that a DAE file may expand to, each instance counted with all that it stands for.
constexpr double kMaxColladaNodes = 100000.0;

/// What is wrong with the XML of a DAE file, or beyond the limits; "": nothing. For messages: "cannot be read: ...".
std::string colladaProblem(const std::string& path);

}  // namespace curtain
