// SPDX-License-Identifier: BSD-3-Clause
//
// A message that is filled again and again. Roscpp hands subscribers of the same process (nodelets) the very object
// that was published, and they may keep it; then a copy takes its place. Subscribers in other processes get bytes.
#pragma once

#include <atomic>
#include <boost/make_shared.hpp>
#include <boost/shared_ptr.hpp>
#include <utility>

namespace curtain_ros {

/// One thread at a time; subscribers let go on any thread.
template <typename Message>
class ReusedMessage {
 public:
  explicit ReusedMessage(Message blank) : message_(boost::make_shared<Message>(std::move(blank))) {}

  /// The message, with what was last filled in, to be changed and published: nobody else holds it.
  boost::shared_ptr<Message> edit() {
    if (message_.use_count() > 1) message_ = boost::make_shared<Message>(*message_);
    // What its last holder read was read before it let go.
    std::atomic_thread_fence(std::memory_order_acquire);
    return message_;
  }

 private:
  boost::shared_ptr<Message> message_;
};

}  // namespace curtain_ros
