// SPDX-License-Identifier: BSD-3-Clause
//
// How a service has something done by the simulation thread. Its own thread leaves a job and waits; the simulation
// thread does the jobs that wait between two frames. It never waits for anybody itself, and when the node stops all who
// wait are told at once.
#pragma once

#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <utility>

namespace curtain_ros {

class Calls {
 public:
  using Job = std::function<void()>;

  /// wake  called, by the caller's thread, when a job waits
  explicit Calls(Job wake) : wake_(std::move(wake)) {}

  /// Returns when the job is done. It must not throw. False: the node stops; it was not done and will not be. Any
  /// thread but the simulation thread.
  bool run(const Job& job);

  /// Does the jobs that have come, in order. Simulation thread.
  void work();

  /// Refuses the jobs that wait, and all to come. When the simulation thread has ended.
  void close();

 private:
  struct Waiting {
    const Job* job;
    std::promise<bool> done;
  };

  Job wake_;
  std::mutex mutex_;
  std::deque<Waiting> waiting_;
  bool closed_ = false;
};

}  // namespace curtain_ros
