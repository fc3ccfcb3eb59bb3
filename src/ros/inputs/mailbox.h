// SPDX-License-Identifier: BSD-3-Clause
//
// How callbacks hand messages to the simulation thread: lock, move, unlock. No lock is held while anybody works with a
// message. Bounded: the oldest message makes room for a new one, and the loss is counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <mutex>
#include <utility>

namespace curtain_ros {

/// Messages of a topic that are kept between two frames; more are told as lost.
constexpr std::size_t kMailboxCapacity = 50;
/// Of roscpp's own queue before that.
constexpr std::uint32_t kQueueSize = 50;

/// Messages from any number of threads to one collector, in order. Thread-safe.
template <typename Message>
class Mailbox {
 public:
  /// capacity  messages kept between two collections, >= 1
  explicit Mailbox(std::size_t capacity) : capacity_(capacity) {}

  void post(Message message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (messages_.size() >= capacity_) {
      messages_.pop_front();
      ++lost_;
    }
    messages_.push_back(std::move(message));
  }

  /// Appends all messages since the last call, oldest first.
  void collect(std::deque<Message>& messages) {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (Message& message : messages_) messages.push_back(std::move(message));
    messages_.clear();
  }

  /// Messages that were pushed out uncollected, since construction.
  std::uint64_t lost() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return lost_;
  }

 private:
  const std::size_t capacity_;
  mutable std::mutex mutex_;
  std::deque<Message> messages_;
  std::uint64_t lost_ = 0;
};

}  // namespace curtain_ros
