// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: work that is done again and again on a thread of its own, by the computer's clock, so that neither a frame
// nor a callback waits for it, and it goes on while /clock stands.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace curtain_ros {

class Periodic {
 public:
  /// Calls work one period from now, and then each period after it ended.
  ///   period  [s], > 0
  Periodic(double period, std::function<void()> work)
      : period_(period), work_(std::move(work)), thread_([this] { run(); }) {}

  /// Waits for the call that is going on.
  ~Periodic() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stop_ = true;
    }
    signal_.notify_all();
    thread_.join();
  }

  Periodic(const Periodic&) = delete;
  Periodic& operator=(const Periodic&) = delete;

 private:
  void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!signal_.wait_for(lock, period_, [this] { return stop_; })) {
      lock.unlock();
      work_();
      lock.lock();
    }
  }

  const std::chrono::duration<double> period_;
  const std::function<void()> work_;
  std::mutex mutex_;
  std::condition_variable signal_;
  bool stop_ = false;
  std::thread thread_;  // last: it uses the others
};

}  // namespace curtain_ros
