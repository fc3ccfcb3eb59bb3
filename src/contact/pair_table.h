// SPDX-License-Identifier: BSD-3-Clause
//
// Finds one of many pairs of elements by its nodes: open addressing with linear probing, filled anew for every use.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/fnv1a.h"

namespace curtain {

/// The nodes of two elements in their order, and what they are: two edges, or a vertex and a triangle.
struct PairKey {
  std::array<std::uint32_t, 4> node;
  bool edges;
  bool operator==(const PairKey& other) const noexcept { return node == other.node && edges == other.edges; }
};

class PairTable {
 public:
  static constexpr std::uint32_t kNone = ~0u;

  /// Empties it and makes room for `count` keys; allocates where there never were so many.
  void clear(std::size_t count) {
    std::size_t slots = 16;
    while (slots < 2 * count) slots *= 2;
    mask_ = slots - 1;
    slots_.assign(slots, Slot{{}, kNone});
    empty_ = true;
  }
  /// A key that is there already keeps its first value.
  void insert(const PairKey& key, std::uint32_t value) noexcept {
    std::size_t at = hash(key) & mask_;
    while (slots_[at].value != kNone) {
      if (slots_[at].key == key) return;
      at = (at + 1) & mask_;
    }
    slots_[at] = {key, value};
    empty_ = false;
  }
  std::uint32_t find(const PairKey& key) const noexcept {
    if (empty_) return kNone;
    std::size_t at = hash(key) & mask_;
    while (slots_[at].value != kNone && !(slots_[at].key == key)) at = (at + 1) & mask_;
    return slots_[at].value;
  }

 private:
  struct Slot {
    PairKey key;
    std::uint32_t value;
  };
  static std::size_t hash(const PairKey& key) noexcept {
    Fnv1a bits;
    bits.hash ^= key.edges ? 1U : 0U;
    for (const std::uint32_t node : key.node) bits.add(node);
    return static_cast<std::size_t>(bits.hash ^ (bits.hash >> 32));
  }

  std::vector<Slot> slots_;
  std::size_t mask_ = 0;
  bool empty_ = true;
};

}  // namespace curtain
