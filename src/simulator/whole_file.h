// SPDX-License-Identifier: BSD-3-Clause
//
// Files that are written completely or not at all.
#pragma once

#include <string>
#include <vector>

#include "curtain_sim/scene.h"

namespace curtain {

/// Writes a file into a temporary one beside it, which is renamed when it is on the disk. On failure (no such folder,
/// no permission, disk full) the problem says what and why, and an existing file is unchanged. No temporary file is
/// left, nor after a kill where the file system has O_TMPFILE (ext4, xfs, btrfs, tmpfs …). Follows symbolic links.
/// Thread-safe; of two writers to one path one wins.
std::vector<Problem> writeWholeFile(const std::string& path, const std::string& bytes);

/// Makes a name that a file got in its folder survive a power failure, where the file system can do that. False: it may
/// not, and errno says why.
bool syncFolderOf(const std::string& path);

/// Closes its descriptor.
class File {
 public:
  explicit File(int descriptor) : descriptor_(descriptor) {}
  ~File() { close(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  bool isOpen() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  /// False: what was written may be lost.
  bool close();

 private:
  int descriptor_;
};

/// What failed on a file, with the reason in errno.
std::vector<Problem> failedOn(const std::string& path, const std::string& what);

}  // namespace curtain
