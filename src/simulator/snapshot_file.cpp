// SPDX-License-Identifier: BSD-3-Clause
#include "curtain_sim/snapshot_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <utility>

#include "simulator/snapshot_format.h"
#include "simulator/whole_file.h"

namespace curtain {
namespace {

// Larger files are not read, whatever their header says: a snapshot of the largest cloth is smaller.
constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 34;

// Reads up to so many bytes; fewer: end of file. -1: see errno.
ssize_t readUpTo(int descriptor, char* to, std::size_t most) {
  std::size_t done = 0;
  while (done < most) {
    const ssize_t count = ::read(descriptor, to + done, most - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return -1;
    if (count == 0) break;
    done += static_cast<std::size_t>(count);
  }
  return static_cast<ssize_t>(done);
}

}  // namespace

std::vector<Problem> writeSnapshotFile(const std::string& path, const std::string& snapshot) {
  return writeWholeFile(path, snapshot);
}

std::vector<Problem> readSnapshotFile(const std::string& path, std::string& out) {
  // O_NONBLOCK: opening a pipe without a writer would block.
  const File file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!file.isOpen()) return failedOn(path, "cannot be read");
  struct stat status {};
  if (::fstat(file.descriptor(), &status) != 0) return failedOn(path, "cannot be read");
  if (!S_ISREG(status.st_mode)) return {{path, "cannot be read: it is not a file"}};
  const auto size = static_cast<std::uint64_t>(status.st_size);
  try {
    std::string bytes(kSnapshotHeader, '\0');
    const ssize_t begun = readUpTo(file.descriptor(), bytes.data(), bytes.size());
    if (begun < 0) return failedOn(path, "cannot be read");
    bytes.resize(static_cast<std::size_t>(begun));
    if (auto problem = judgeHeader(bytes, size)) return {{path, problem->text}};
    if (size > kMaxBytes) return {{path, "is too large for a snapshot: " + std::to_string(size) + " bytes"}};
    bytes.resize(size);
    const ssize_t rest = readUpTo(file.descriptor(), bytes.data() + kSnapshotHeader, size - kSnapshotHeader);
    if (rest < 0) return failedOn(path, "cannot be read");
    if (static_cast<std::uint64_t>(rest) != size - kSnapshotHeader)
      return {{path, "cannot be read: it changes meanwhile"}};
    out = std::move(bytes);
  } catch (const std::bad_alloc&) {
    return {{path, "cannot be read: there is not enough memory"}};
  }
  return {};
}

}  // namespace curtain
