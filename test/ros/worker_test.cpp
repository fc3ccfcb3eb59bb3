// SPDX-License-Identifier: BSD-3-Clause
//
// One thread does all jobs, in order; it starts with the first and ends with its owner.
#include "ros/sensors/worker.h"

#include <gtest/gtest.h>

#include <future>
#include <set>

namespace curtain_ros {
namespace {

TEST(Worker, DoesAllJobsOnOneThread) {
  Worker worker;
  worker.finish();  // nothing was begun
  std::set<std::thread::id> threads;
  int done = 0;
  for (int job = 0; job < 100; ++job) {
    ASSERT_FALSE(worker.busy());
    worker.begin([&] {
      threads.insert(std::this_thread::get_id());
      ++done;
    });
    worker.finish();
  }
  EXPECT_EQ(done, 100);
  EXPECT_EQ(threads.size(), 1U);
  EXPECT_EQ(threads.count(std::this_thread::get_id()), 0U);
}

TEST(Worker, IsBusyUntilTheJobIsDone) {
  std::promise<void> begun, go_on;
  bool done = false;
  {
    Worker worker;
    worker.begin([&] {
      begun.set_value();
      go_on.get_future().wait();
      done = true;
    });
    begun.get_future().wait();
    EXPECT_TRUE(worker.busy());
    go_on.set_value();
  }
  EXPECT_TRUE(done) << "its end waits";
}

}  // namespace
}  // namespace curtain_ros
