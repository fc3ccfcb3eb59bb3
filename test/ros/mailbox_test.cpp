// SPDX-License-Identifier: BSD-3-Clause
//
// Messages come out in order, once; the oldest make room when there are too many, and are counted.
#include "ros/inputs/mailbox.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace curtain_ros {
namespace {

template <typename Message>
std::deque<Message> collect(Mailbox<Message>& box) {
  std::deque<Message> messages;
  box.collect(messages);
  return messages;
}

TEST(Mailbox, HandsOutEachMessageOnceInOrder) {
  Mailbox<std::unique_ptr<int>> box(3);
  box.post(std::make_unique<int>(1));
  box.post(std::make_unique<int>(2));
  const auto messages = collect(box);
  ASSERT_EQ(messages.size(), 2U);
  EXPECT_EQ(*messages[0], 1);
  EXPECT_EQ(*messages[1], 2);
  EXPECT_TRUE(collect(box).empty());
  EXPECT_EQ(box.lost(), 0U);
}

// Messages that still wait with the collector stay in front.
TEST(Mailbox, AppendsToWhatIsThere) {
  Mailbox<int> box(3);
  box.post(2);
  std::deque<int> messages = {1};
  box.collect(messages);
  EXPECT_EQ(messages, (std::deque<int>{1, 2}));
}

TEST(Mailbox, DropsAndCountsTheOldest) {
  Mailbox<int> box(3);
  for (int i = 0; i < 5; ++i) box.post(i);
  EXPECT_EQ(collect(box), (std::deque<int>{2, 3, 4}));
  EXPECT_EQ(box.lost(), 2U);
}

// Messages of several threads all arrive, and those of one thread in their order.
TEST(Mailbox, TakesMessagesFromSeveralThreads) {
  constexpr int kThreads = 4;
  constexpr int kMessages = 1000;
  Mailbox<std::pair<int, int>> box(kThreads * kMessages);
  std::vector<std::thread> threads;
  for (int thread = 0; thread < kThreads; ++thread) {
    threads.emplace_back([&box, thread] {
      for (int i = 0; i < kMessages; ++i) box.post({thread, i});
    });
  }
  std::vector<int> next(kThreads, 0);
  int received = 0;
  while (received < kThreads * kMessages) {
    for (const auto& message : collect(box)) {
      EXPECT_EQ(message.second, next[static_cast<std::size_t>(message.first)]++);
      ++received;
    }
    std::this_thread::yield();
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(box.lost(), 0U);
}

}  // namespace
}  // namespace curtain_ros
