// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: how callbacks hand letters to the simulation thread: lock, move, unlock. No lock is held while
// anybody works with a letter. Bounded: the oldest letter makes room for a new one, and the loss is counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <utility>

namespace curtain_ros {

/// Letters from any number of threads to one collector, in order. Thread-safe.
template <typename Letter>
class Mailbox {
 public:
  /// capacity  letters kept between two collections, >= 1
  explicit Mailbox(std::size_t capacity) : capacity_(capacity) {}

  void post(Letter letter) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (letters_.size() >= capacity_) {
      letters_.pop_front();
      ++lost_;
    }
    letters_.push_back(std::move(letter));
  }

  /// Appends all letters since the last call, oldest first.
  void collect(std::deque<Letter>& letters) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (Letter& letter : letters_) letters.push_back(std::move(letter));
    letters_.clear();
  }

  /// Letters that were pushed out uncollected, since construction.
  std::uint64_t lost() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return lost_;
  }

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::deque<Letter> letters_;
  std::uint64_t lost_ = 0;
};

}  // namespace curtain_ros
