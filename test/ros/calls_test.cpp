// SPDX-License-Identifier: BSD-3-Clause
//
// Jobs of other threads are done by the one that works, in order, and who waits is told, whatever happens.
#include "ros/services/calls.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace curtain_ros {
namespace {

// Counts what has come, so that tests wait for that and not for a time.
struct Doorbell {
  std::atomic<int> rung{0};
  void waitFor(int count) const {
    while (rung < count) std::this_thread::yield();
  }
};

TEST(Calls, AreDoneByTheThreadThatWorks) {
  Doorbell bell;
  Calls calls([&bell] { ++bell.rung; });
  std::thread::id done_by;
  bool done = false;
  std::thread caller([&] { done = calls.run([&] { done_by = std::this_thread::get_id(); }); });
  bell.waitFor(1);
  EXPECT_EQ(done_by, std::thread::id()) << "not before it works";
  calls.work();
  caller.join();
  EXPECT_TRUE(done);
  EXPECT_EQ(done_by, std::this_thread::get_id());
}

TEST(Calls, OfOneThreadKeepTheirOrderAndNoneIsLost) {
  Calls calls([] {});
  std::atomic<int> callers{4};
  std::vector<std::vector<int>> seen(4);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < seen.size(); ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 100; ++i) EXPECT_TRUE(calls.run([&seen, t, i] { seen[t].push_back(i); }));
      --callers;
    });
  }
  while (callers > 0) calls.work();
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<int>& of_one : seen) {
    ASSERT_EQ(of_one.size(), 100U);
    for (int i = 0; i < 100; ++i) EXPECT_EQ(of_one[static_cast<std::size_t>(i)], i);
  }
}

// Whoever waits when the node stops, or comes later, is told at once that nothing was done.
TEST(Calls, AreRefusedOnceClosed) {
  Doorbell bell;
  Calls calls([&bell] { ++bell.rung; });
  std::atomic<int> refused{0}, done{0};
  std::vector<std::thread> callers;
  for (int i = 0; i < 3; ++i) {
    callers.emplace_back([&] {
      if (!calls.run([&done] { ++done; })) ++refused;
    });
  }
  bell.waitFor(3);
  calls.close();
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(refused, 3);
  EXPECT_FALSE(calls.run([&done] { ++done; }));
  calls.work();
  EXPECT_EQ(done, 0);
}

// A job may come while another is done: it is done, too, and nobody holds a lock meanwhile.
TEST(Calls, MayComeWhileOneIsDone) {
  Doorbell bell;
  Calls calls([&bell] { ++bell.rung; });
  bool second = false;
  std::thread other;
  std::thread caller([&] {
    calls.run([&] {
      other = std::thread([&] { calls.run([&second] { second = true; }); });
      bell.waitFor(2);
    });
  });
  bell.waitFor(1);
  calls.work();
  caller.join();
  other.join();
  EXPECT_TRUE(second);
}

}  // namespace
}  // namespace curtain_ros
