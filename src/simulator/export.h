// SPDX-License-Identifier: BSD-3-Clause
//
// States, meshes and statistics as files. All throw std::runtime_error naming the file when it can't be written.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain {

/// Header line and rows `t,row,column,x,y,z,vx,vy,vz` of the first-layer nodes, 17 digits.
void writeStateHeader(std::ostream& out);
void writeState(const Simulator& simulator, std::ostream& out);

/// The fine mesh as .ply (ASCII) or .obj, by the path's ending; throws std::invalid_argument for another one.
void writeMesh(const Simulator& simulator, const std::string& path);

/// What curtain_batch --stats writes. frame_seconds: computing time of every frame [s].
std::string statisticsJson(const Simulator& simulator, const Energy& initial, const std::vector<double>& frame_seconds);

}  // namespace curtain
