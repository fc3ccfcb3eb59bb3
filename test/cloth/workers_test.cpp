// SPDX-License-Identifier: BSD-3-Clause
//
// Loops that threads share: every block once, whoever comes to help and however often shifts begin and end.
#include "cloth/workers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <set>
#include <thread>
#include <vector>

namespace curtain {
namespace {

TEST(Workers, DoEachBlockOnce) {
  for (const int threads : {1, 2, 3, 8}) {
    const Workers workers(threads);
    for (int shift = 0; shift < 40; ++shift) {
      const Workers::Shift standing_by(workers);
      for (const int count : {0, 1, 2, 7, 64, 1000, 70000}) {
        std::vector<int> done(static_cast<std::size_t>(count), 0);
        workers.run(count, [&](int b) { ++done[static_cast<std::size_t>(b)]; });
        ASSERT_EQ(std::count(done.begin(), done.end(), 1), count) << threads << " threads";
      }
    }
  }
}

TEST(Workers, SeeWhatTheLoopBeforeHasWritten) {
  const Workers workers(4);
  const Workers::Shift standing_by(workers);
  std::vector<long> sums(257, 0);
  for (long loop = 1; loop <= 3000; ++loop) {
    // Each block reads what its neighbour wrote in the last loop.
    std::vector<long> next(sums.size());
    workers.run(static_cast<int>(sums.size()), [&](int b) {
      const auto at = static_cast<std::size_t>(b);
      next[at] = sums[(at + 1) % sums.size()] + 1;
    });
    ASSERT_EQ(std::accumulate(next.begin(), next.end(), 0L), loop * static_cast<long>(sums.size()));
    sums = next;
  }
}

TEST(Workers, HelpWhenBlocksTakeLong) {
  // There is nobody to help on one core.
  const std::size_t expected = std::thread::hardware_concurrency() < 2 ? 1 : 2;
  const Workers workers(2);
  std::set<std::thread::id> seen;
  for (int attempt = 0; attempt < 1000 && seen.size() < expected; ++attempt) {
    const Workers::Shift standing_by(workers);
    std::vector<std::thread::id> by(2);
    std::atomic<int> begun{0};
    // Whoever comes first waits for the other a while.
    workers.run(2, [&](int b) {
      ++begun;
      for (int k = 0; k < 1000 && begun < 2; ++k) std::this_thread::yield();
      by[static_cast<std::size_t>(b)] = std::this_thread::get_id();
    });
    seen.insert(by.begin(), by.end());
  }
  EXPECT_EQ(seen.size(), expected);
}

TEST(Workers, WithoutAShiftTheCallerIsAlone) {
  const Workers workers(4);
  workers.run(1000, [caller = std::this_thread::get_id()](int) { EXPECT_EQ(std::this_thread::get_id(), caller); });
}

TEST(Workers, AreAsManyAsPay) {
  EXPECT_EQ(threadsFor(0, 1760), 1);
  EXPECT_EQ(threadsFor(0, 10080), std::min(2, std::max(1, static_cast<int>(std::thread::hardware_concurrency()))));
  EXPECT_EQ(threadsFor(5, 10), 5);
}

}  // namespace
}  // namespace curtain
