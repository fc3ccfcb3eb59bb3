// SPDX-License-Identifier: BSD-3-Clause
//
// Mesh files into triangles. STL, OBJ and DAE by assimp; what it hands out is checked here, because it passes on
// NaN, triangles without area and files without triangles.
#pragma once

#include <string>

#include "curtain_sim/obstacle_shape.h"

namespace curtain {

/// Reads a mesh file: all its parts in their places, polygons cut into triangles, equal corners shared.
///   path      of the file system
///   scale     factor to metres per axis, each != 0; a mirrored mesh keeps its outside
///   obstacle  name for the messages
/// No other file is opened, whatever this one names (materials). Limits: 256 MiB, 4 million triangles, polygons of 1000
/// corners; DAE: elements 100 deep in each other, 100000 nodes.
/// The unit of a DAE file is applied, its up axis is not (as rviz does). Throws std::invalid_argument
/// "obstacle 'NAME': mesh 'PATH' REASON": missing, unreadable, without triangles, without area, not finite.
ShapeTriangles loadMesh(const std::string& path, const Vec3& scale, const std::string& obstacle);

/// Nodes that a DAE file may expand to, each instance counted with all that it stands for.
constexpr double kMostColladaNodes = 100000.0;

/// What is wrong with the XML of a DAE file, or beyond the limits; "": nothing. For messages: "cannot be read: ...".
std::string colladaProblem(const std::string& path);

}  // namespace curtain
