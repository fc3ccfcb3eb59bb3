// SPDX-License-Identifier: BSD-3-Clause
//
// FNV-1a hash (Fowler, Noll, Vo), 64 bits, with their basis and prime.
#pragma once

#include <cstddef>
#include <cstdint>

namespace curtain {

struct Fnv1a {
  std::uint64_t hash = 14695981039346656037ULL;

  /// Adds a byte, as in FNV-1a, or a whole word: another hash, faster and good enough for a table.
  void add(std::uint64_t unit) noexcept { hash = (hash ^ unit) * 1099511628211ULL; }
  void addBytes(const void* data, std::size_t count) noexcept {
    const auto* const bytes = static_cast<const unsigned char*>(data);
    for (std::size_t n = 0; n < count; ++n) add(bytes[n]);
  }
};

}  // namespace curtain
