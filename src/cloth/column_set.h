// SPDX-License-Identifier: BSD-3-Clause
//
// A subset of a cloth's columns.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace curtain {

/// Adjacent columns, [first, end).
struct ColumnSpan {
  std::size_t first = 0;
  std::size_t end = 0;

  /// Weft links with an end in the span, in open cloth; in a ring, where the span is all columns, all but the closing
  /// link.
  std::size_t firstLink() const noexcept { return first > 0 ? first : 1; }
  std::size_t endLink(std::size_t columns) const noexcept { return end < columns ? end + 1 : columns; }
};

class ColumnSet {
 public:
  explicit ColumnSet(int columns) : in_(static_cast<std::size_t>(columns), 0) {}

  bool has(int column) const noexcept { return in_[static_cast<std::size_t>(column)] != 0; }
  int columns() const noexcept { return static_cast<int>(in_.size()); }
  int count() const noexcept { return count_; }
  bool empty() const noexcept { return count_ == 0; }
  bool full() const noexcept { return count_ == columns(); }

  void add(int column) noexcept {
    std::uint8_t& in = in_[static_cast<std::size_t>(column)];
    count_ += in == 0 ? 1 : 0;
    in = 1;
  }
  void remove(int column) noexcept {
    std::uint8_t& in = in_[static_cast<std::size_t>(column)];
    count_ -= in;
    in = 0;
  }
  void addAll() noexcept {
    std::fill(in_.begin(), in_.end(), std::uint8_t{1});
    count_ = columns();
  }
  void clear() noexcept {
    std::fill(in_.begin(), in_.end(), std::uint8_t{0});
    count_ = 0;
  }

 private:
  std::vector<std::uint8_t> in_;
  int count_ = 0;
};

}  // namespace curtain
