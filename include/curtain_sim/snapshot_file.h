// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 4: snapshots of a simulator (Simulator::snapshot(), restore()) as files.
#pragma once

#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// Writes a snapshot to a file, completely or not at all: into a temporary file beside it, which is renamed when it is
/// on the disk. On failure (no such folder, no permission, disk full) the problem says what and why, and an existing
/// file is unchanged. No temporary file is left, nor after a kill where the file system has O_TMPFILE (ext4, xfs,
/// btrfs, tmpfs …). Follows symbolic links. Thread-safe; of two writers to one path one wins.
std::vector<Problem> writeSnapshotFile(const std::string& path, const std::string& snapshot);

/// Reads a snapshot from a file that begins like one and has the length it names; Simulator::restore() checks its
/// content and scene. Otherwise returns what is wrong, and out is unchanged.
std::vector<Problem> readSnapshotFile(const std::string& path, std::string& out);

}  // namespace curtain
