// SPDX-License-Identifier: BSD-3-Clause
//
// The hash of Fowler, Noll and Vo, FNV-1a, 64 bits: basis and prime are theirs.
#pragma once

#include <cstddef>
#include <cstdint>

namespace curtain {

struct Fnv1a {
  std::uint64_t hash = 14695981039346656037ULL;

  /// A byte, as they have it, or a whole word: not the same hash, but one that is good enough for a table and faster.
  void add(std::uint64_t unit) noexcept { hash = (hash ^ unit) * 1099511628211ULL; }
  void addBytes(const void* data, std::size_t count) noexcept {
    const auto* const bytes = static_cast<const unsigned char*>(data);
    for (std::size_t n = 0; n < count; ++n) add(bytes[n]);
  }
};

}  // namespace curtain
