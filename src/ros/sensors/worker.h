// SPDX-License-Identifier: BSD-3-Clause
//
// A thread that does one job after another. It lives as long as its owner, since libraries keep things for each thread
// that ever used them.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace curtain_ros {

/// Its owner's thread only. What a job wrote may be read when busy() is false.
class Worker {
 public:
  Worker() = default;
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// Begins a job, which throws nothing. Only where nothing is being done. The thread starts with the first one: throws
  /// std::system_error when there can't be one.
  void begin(std::function<void()> job);

  bool busy() const;

  /// Waits until what was begun is done.
  void finish();

 private:
  void run();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> job_;  // none: nothing to do
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace curtain_ros
