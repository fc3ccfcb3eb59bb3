// SPDX-License-Identifier: BSD-3-Clause
//
// Positions of nodes in a file: a table as curtain_batch --out writes it, or a mesh as its --mesh.
#pragma once

#include <string>
#include <vector>

#include "cloth/cloth.h"
#include "curtain_sim/scene.h"

namespace curtain {

/// Positions [m] of the first-layer nodes, row by row. cloth: whose grid they are on. Throws std::invalid_argument with
/// what is wrong with the file.
std::vector<Vec3> readStartFile(const std::string& path, const ClothParams& cloth);

/// What is wrong with cloth that starts there: a link that is longer than it may be, or a rod that is shorter; parts of
/// the cloth that cross. Empty: nothing.
std::string problemOfStart(const Scene& scene, const ClothPattern& pattern, const Field3& position);

}  // namespace curtain
