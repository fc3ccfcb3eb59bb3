// SPDX-License-Identifier: BSD-3-Clause
//
// States, meshes and statistics as files. All throw std::runtime_error naming the file when it can't be written.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain {

/// Header line and rows `t,row,column,x,y,z,vx,vy,vz` of the first-layer nodes, 17 digits.
void writeStateHeader(std::ostream& out);
void writeState(const Simulator& simulator, std::ostream& out);

/// Kinds of mesh files, with the endings of their names, for messages.
enum class MeshFormat { kPly, kObj, kStl };
constexpr char kMeshEndings[] = ".ply, .obj or .stl";
std::optional<MeshFormat> meshFormatOf(const std::string& path);  ///< by the name's ending; none: another one

/// A mesh as the content of a file: PLY and OBJ as text with 9 digits, STL as binary, single precision, facets' normals
/// by the right-hand rule. In metres.
std::string meshFile(const FineMesh& mesh, const FineMeshTopology& topology, MeshFormat format);

/// The fine mesh as a file, whole or not at all; throws std::invalid_argument for another ending than kMeshEndings.
void writeMesh(const Simulator& simulator, const std::string& path);

/// What curtain_batch --stats writes. frame_seconds: computing time of every frame [s].
std::string statisticsJson(const Simulator& simulator, const Energy& initial, const std::vector<double>& frame_seconds);

}  // namespace curtain
