// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: messages that are filled again and again. roscpp hands subscribers of the same process (nodelets) the very
// object that was published, and they may keep it; so a message is filled again only once nobody else holds it. Whoever
// keeps messages makes the pool grow, up to kMost; beyond it the oldest is left to its keeper, and a new one is made.
// Subscribers in other processes get bytes, for which roscpp takes memory of its own with each message.
#pragma once

#include <atomic>
#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <cstddef>
#include <utility>
#include <vector>

namespace curtain_ros {

/// One thread at a time; subscribers let go on any thread.
///   Content  says what a message holds, so that what is still right need not be filled in again; default: nothing
template <typename Message, typename Content>
class MessagePool {
 public:
  struct Entry {
    boost::shared_ptr<Message> message;
    Content content;
  };

  /// New messages are copies of the blank.
  explicit MessagePool(Message blank) : blank_(std::move(blank)) { entries_.reserve(kMost); }

  /// A message that nobody else holds, as it was when it was last filled. Valid until the next call.
  Entry& take() {
    for (Entry& entry : entries_) {
      if (entry.message.use_count() > 1) continue;
      // What its last holder read was read before it let go.
      std::atomic_thread_fence(std::memory_order_acquire);
      return entry;
    }
    if (entries_.size() == kMost) entries_.erase(entries_.begin());
    entries_.push_back({boost::make_shared<Message>(blank_), Content()});
    return entries_.back();
  }

 private:
  static constexpr std::size_t kMost = 8;

  Message blank_;
  std::vector<Entry> entries_;
};

}  // namespace curtain_ros
