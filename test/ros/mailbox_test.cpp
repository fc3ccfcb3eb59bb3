// SPDX-License-Identifier: BSD-3-Clause
//
// Letters come out in order, once; the oldest make room when there are too many, and are counted.
#include "ros/inputs/mailbox.h"

#include <gtest/gtest.h>

#include <memory>
#include <thread>
#include <vector>

namespace curtain_ros {
namespace {

template <typename Letter>
std::deque<Letter> collect(Mailbox<Letter>& box) {
  std::deque<Letter> letters;
  box.collect(letters);
  return letters;
}

TEST(Mailbox, HandsOutEachLetterOnceInOrder) {
  Mailbox<std::unique_ptr<int>> box(3);
  box.post(std::make_unique<int>(1));
  box.post(std::make_unique<int>(2));
  const auto letters = collect(box);
  ASSERT_EQ(letters.size(), 2U);
  EXPECT_EQ(*letters[0], 1);
  EXPECT_EQ(*letters[1], 2);
  EXPECT_TRUE(collect(box).empty());
  EXPECT_EQ(box.lost(), 0U);
}

// Letters that still wait with the collector stay in front.
TEST(Mailbox, AppendsToWhatIsThere) {
  Mailbox<int> box(3);
  box.post(2);
  std::deque<int> letters = {1};
  box.collect(letters);
  EXPECT_EQ(letters, (std::deque<int>{1, 2}));
}

TEST(Mailbox, DropsAndCountsTheOldest) {
  Mailbox<int> box(3);
  for (int i = 0; i < 5; ++i) box.post(i);
  EXPECT_EQ(collect(box), (std::deque<int>{2, 3, 4}));
  EXPECT_EQ(box.lost(), 2U);
}

// Letters of several threads all arrive, and those of one thread in their order.
TEST(Mailbox, TakesLettersFromSeveralThreads) {
  constexpr int kThreads = 4;
  constexpr int kLetters = 1000;
  Mailbox<std::pair<int, int>> box(kThreads * kLetters);
  std::vector<std::thread> threads;
  for (int thread = 0; thread < kThreads; ++thread) {
    threads.emplace_back([&box, thread] {
      for (int i = 0; i < kLetters; ++i) box.post({thread, i});
    });
  }
  std::vector<int> next(kThreads, 0);
  int received = 0;
  while (received < kThreads * kLetters) {
    for (const auto& letter : collect(box)) {
      EXPECT_EQ(letter.second, next[static_cast<std::size_t>(letter.first)]++);
      ++received;
    }
    std::this_thread::yield();
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(box.lost(), 0U);
}

}  // namespace
}  // namespace curtain_ros
