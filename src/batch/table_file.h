// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 6: a file of --out or --wrenches, which a run that goes on from a checkpoint takes up where the checkpoint left
// it, byte for byte. So it knows its length and the hash of what it holds.
#pragma once

#include <array>
#include <cstdint>
#include <ostream>
#include <streambuf>
#include <string>

#include "scene/fnv1a.h"
#include "simulator/whole_file.h"

namespace curtain_batch {

/// How far the file is.
struct TableMark {
  std::uint64_t bytes = 0;
  std::uint64_t hash = curtain::Fnv1a{}.hash;  ///< FNV-1a of these bytes
};

/// Throws std::runtime_error naming the file and the reason when it can't be written. Not thread-safe.
class TableFile : private std::streambuf {
 public:
  /// A new file, or an old one written over.
  explicit TableFile(const std::string& path);
  /// Goes on with a file at a mark; what is behind it is cut off. Throws std::invalid_argument, and leaves the file as
  /// it is, if it does not begin with what the mark is of.
  TableFile(const std::string& path, const TableMark& mark);

  /// Calls write(stream), which throws what the file refuses.
  template <typename Write>
  void add(const Write& write) {
    std::ostream out(this);
    out.exceptions(std::ios::badbit);  // lets the reason through
    write(out);
  }
  /// Hands everything to the system, which a full disk may refuse.
  void flush();
  /// The same, and waits until it is on the disk, under its name.
  TableMark toDisk();

 private:
  int_type overflow(int_type character) override;
  void writeBuffer();

  std::string path_;
  curtain::File file_;
  TableMark mark_;
  bool name_is_on_disk_ = false;
  std::array<char, 1 << 16> buffer_{};
};

}  // namespace curtain_batch
