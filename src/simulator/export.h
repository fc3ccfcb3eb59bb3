// SPDX-License-Identifier: BSD-3-Clause
//
// States, meshes and statistics as files. All throw std::runtime_error naming the file when it can't be written.
#pragma once

#include <array>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain {

/// Header line and rows `t,row,column,x,y,z,vx,vy,vz` of the first-layer nodes, 17 digits.
void writeStateHeader(std::ostream& out);
void writeState(const Simulator& simulator, std::ostream& out);

/// Wrench of the cloth on each obstacle, mean over the last frame, about the obstacle's origin, world axes [N], [N m]:
/// a CSV line an obstacle.
void writeWrenchHeader(std::ostream& out);
void writeWrenches(const Simulator& simulator, std::ostream& out);

/// Kinds of mesh files, with the endings of their names, for messages.
enum class MeshFormat { kPly, kObj, kStl };
constexpr char kMeshEndings[] = ".ply, .obj or .stl";
std::optional<MeshFormat> meshFormatOf(const std::string& path);  ///< by the name's ending; none: another one

/// A mesh as the content of a file: PLY and OBJ as text with 9 digits, STL as binary, single precision, facets' normals
/// by the right-hand rule. In metres.
std::string meshFile(const FineMesh& mesh, const FineMeshTopology& topology, MeshFormat format);

/// The fine mesh as a file, whole or not at all; throws std::invalid_argument for another ending than kMeshEndings.
void writeMesh(const Simulator& simulator, const std::string& path);

/// What frames of a run add up to.
struct RunSums {
  Energy initial;                                            ///< where the run began
  std::vector<double> frame_seconds;                         ///< computing time of every frame so far [s]
  std::array<std::int64_t, kFrameQualityCount> frames_of{};  ///< frames by their FrameQuality
  std::vector<ContactWrench> loads;  ///< by obstacle: means so far, over the time that the forces acted for

  /// After a frame.
  void add(const Simulator& simulator);
};

/// What curtain_batch --stats writes.
std::string statisticsJson(const Simulator& simulator, const RunSums& run);

/// What the last resort has done to a run, in words; empty: nothing.
std::string describeLastResort(const Statistics& statistics);

}  // namespace curtain
