// SPDX-License-Identifier: BSD-3-Clause
#include "simulator/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <utility>

namespace curtain {
namespace {

bool writeAll(int descriptor, const std::string& bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t count = ::write(descriptor, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

// Tries names beside the file until create(name) succeeds: it makes the file, or fails with EEXIST if another thread or
// process uses the name. False: it failed with another errno.
template <typename Create>
bool claimNameBeside(const std::string& path, std::string& name, const Create& create) {
  static std::atomic<unsigned> next{0};
  do {
    name = path + ".tmp-" + std::to_string(::getpid()) + '-' + std::to_string(next++);
    if (create(name.c_str())) return true;
  } while (errno == EEXIST);
  return false;
}

std::string folderOf(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

// Names the file only when it is complete, so that nothing is left when the process is killed. Not all file systems can
// do that.
bool writeNamedAtLast(const std::string& path, const std::string& bytes, std::string& name) {
  File file(::open(folderOf(path).c_str(), O_WRONLY | O_TMPFILE | O_CLOEXEC, 0666));
  if (!file.isOpen() || !writeAll(file.descriptor(), bytes) || ::fsync(file.descriptor()) != 0) return false;
  const std::string nameless = "/proc/self/fd/" + std::to_string(file.descriptor());
  return claimNameBeside(path, name, [&](const char* to) {
    return ::linkat(AT_FDCWD, nameless.c_str(), AT_FDCWD, to, AT_SYMLINK_FOLLOW) == 0;
  });
}

// Fallback: a file with a name from the start. On failure it is removed, and errno says why.
bool writeNamed(const std::string& path, const std::string& bytes, std::string& name) {
  int descriptor = -1;
  const auto create = [&](const char* as) {
    descriptor = ::open(as, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);  // reduced by the umask
    return descriptor >= 0;
  };
  if (!claimNameBeside(path, name, create)) return false;
  File file(descriptor);
  if (writeAll(descriptor, bytes) && ::fsync(descriptor) == 0 && file.close()) return true;
  const int why = errno;
  ::unlink(name.c_str());
  errno = why;
  return false;
}

}  // namespace

bool syncFolderOf(const std::string& path) {
  const File file(::open(folderOf(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!file.isOpen()) return errno == EACCES;  // writable but not readable
  return ::fsync(file.descriptor()) == 0 || errno == EINVAL || errno == ENOTSUP;
}

bool File::close() {
  const int descriptor = std::exchange(descriptor_, -1);
  return descriptor < 0 || ::close(descriptor) == 0;
}

std::vector<Problem> failedOn(const std::string& path, const std::string& what) {
  return {{path, what + ": " + std::generic_category().message(errno)}};
}

std::vector<Problem> writeWholeFile(const std::string& path, const std::string& bytes) {
  std::error_code ignored;
  const bool is_link = std::filesystem::is_symlink(path, ignored) && std::filesystem::exists(path, ignored);
  const std::string target = is_link ? std::filesystem::canonical(path, ignored).string() : path;
  if (std::filesystem::exists(target, ignored) && !std::filesystem::is_regular_file(target, ignored)) {
    return {{path, "cannot be written: it is not a file"}};
  }
  std::string name;
  if (!writeNamedAtLast(target, bytes, name) && !writeNamed(target, bytes, name)) {
    return failedOn(path, "cannot be written");
  }
  if (std::rename(name.c_str(), target.c_str()) != 0) {
    std::vector<Problem> problems = failedOn(path, "cannot be written");
    ::unlink(name.c_str());
    return problems;
  }
  if (!syncFolderOf(target)) return failedOn(path, "is written, but may not outlast a power failure");
  return {};
}

}  // namespace curtain
