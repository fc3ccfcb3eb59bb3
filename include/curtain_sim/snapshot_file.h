// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 4: snapshots of a simulator (Simulator::snapshot(), restore()) as files.
#pragma once

#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// Writes a snapshot to a file, all of it or nothing: into a temporary file beside it, which takes its name when it is
/// on the disk. Where that fails (no such folder, no permission, disk full) the problem says what and why, a file that
/// was there is as it was, and no temporary one is left; nor when the process is killed (where the file system knows
/// O_TMPFILE: ext4, xfs, btrfs, tmpfs …). A link is followed. Thread-safe; two at once to one path: one of them wins.
std::vector<Problem> writeSnapshotFile(const std::string& path, const std::string& snapshot);

/// Reads a snapshot from a file. Only what begins like a snapshot and is as long as it says is read; whether it is a
/// sound one, and of which scene, Simulator::restore() tells. Otherwise the problem says what is wrong, and out is as
/// it was.
std::vector<Problem> readSnapshotFile(const std::string& path, std::string& out);

}  // namespace curtain
