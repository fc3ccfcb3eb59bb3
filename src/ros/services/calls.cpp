// SPDX-License-Identifier: BSD-3-Clause
#include "ros/services/calls.h"

namespace curtain_ros {

bool Calls::run(const Job& job) {
  Waiting waiting{&job, {}};
  std::future<bool> done = waiting.done.get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (closed_) return false;
    waiting_.push_back(std::move(waiting));
  }
  wake_();
  return done.get();
}

// One at a time: no lock is held while a job is done, and none that comes meanwhile is missed.
void Calls::work() {
  while (true) {
    Waiting next;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (waiting_.empty()) return;
      next = std::move(waiting_.front());
      waiting_.pop_front();
    }
    (*next.job)();
    next.done.set_value(true);
  }
}

void Calls::close() {
  const std::lock_guard<std::mutex> lock(mutex_);
  closed_ = true;
  for (Waiting& waiting : waiting_) waiting.done.set_value(false);
  waiting_.clear();
}

}  // namespace curtain_ros
