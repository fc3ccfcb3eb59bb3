// SPDX-License-Identifier: BSD-3-Clause
#include "batch/table_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>

namespace curtain_batch {
namespace {

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw std::runtime_error(curtain::describe(curtain::failedOn(path, what)));
}

// The mark's hash, of the first bytes of the file; stops where the file ends.
TableMark markOf(int descriptor, std::uint64_t bytes) {
  std::array<char, 1 << 16> buffer{};
  TableMark mark;
  curtain::Fnv1a hash;
  while (mark.bytes < bytes) {
    const ssize_t count = ::read(descriptor, buffer.data(), std::min<std::uint64_t>(buffer.size(), bytes - mark.bytes));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    hash.addBytes(buffer.data(), static_cast<std::size_t>(count));
    mark.bytes += static_cast<std::uint64_t>(count);
  }
  mark.hash = hash.hash;
  return mark;
}

}  // namespace

TableFile::TableFile(const std::string& path)
    : path_(path), file_(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (!file_.isOpen()) fail(path_, "cannot be written");
  setp(buffer_.data(), buffer_.data() + buffer_.size());
}

TableFile::TableFile(const std::string& path, const TableMark& mark)
    : path_(path), file_(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)), mark_(mark) {
  const TableMark there = file_.isOpen() ? markOf(file_.descriptor(), mark.bytes) : TableMark{};
  if (there.bytes != mark.bytes || there.hash != mark.hash) {
    throw std::invalid_argument(path + ": is not the file that the checkpoint goes on with");
  }
  const auto length = static_cast<off_t>(mark.bytes);
  if (::ftruncate(file_.descriptor(), length) != 0 || ::lseek(file_.descriptor(), length, SEEK_SET) != length) {
    fail(path_, "cannot be written");
  }
  setp(buffer_.data(), buffer_.data() + buffer_.size());
}

void TableFile::flush() { writeBuffer(); }

TableMark TableFile::toDisk() {
  writeBuffer();
  // A pipe or a device can't wait for a disk.
  if (::fsync(file_.descriptor()) != 0 && errno != EINVAL && errno != ENOTSUP) fail(path_, "cannot be written");
  if (!name_is_on_disk_ && !curtain::syncFolderOf(path_)) fail(path_, "may not outlast a power failure");
  name_is_on_disk_ = true;
  return mark_;
}

TableFile::int_type TableFile::overflow(int_type character) {
  writeBuffer();
  if (!traits_type::eq_int_type(character, traits_type::eof())) sputc(traits_type::to_char_type(character));
  return traits_type::not_eof(character);
}

void TableFile::writeBuffer() {
  while (pbase() < pptr()) {
    const ssize_t count = ::write(file_.descriptor(), pbase(), static_cast<std::size_t>(pptr() - pbase()));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) fail(path_, "cannot be written");
    curtain::Fnv1a hash{mark_.hash};
    hash.addBytes(pbase(), static_cast<std::size_t>(count));
    mark_.hash = hash.hash;
    mark_.bytes += static_cast<std::uint64_t>(count);
    const auto rest = std::copy(pbase() + count, pptr(), pbase()) - pbase();  // a disk that is nearly full takes less
    setp(buffer_.data(), buffer_.data() + buffer_.size());
    pbump(static_cast<int>(rest));
  }
}

}  // namespace curtain_batch
