// SPDX-License-Identifier: BSD-3-Clause
//
// Work that is done again and again on a thread of its own, by the monotonic clock: neither a frame nor a callback
// waits for it, and it goes on while /clock stands.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <functional>
#include <utility>

namespace curtain_ros {

class Periodic {
 public:
  /// Calls work each period [s], > 0, the first time one period from now. The destructor waits for a call that is going
  /// on.
  Periodic(double period, std::function<void()> work) : spinner_(1, &queue_) {
    ros::NodeHandle node;
    node.setCallbackQueue(&queue_);
    timer_ = node.createSteadyTimer(ros::WallDuration(period),
                                    [work = std::move(work)](const ros::SteadyTimerEvent&) { work(); });
    spinner_.start();
  }

  Periodic(const Periodic&) = delete;
  Periodic& operator=(const Periodic&) = delete;

 private:
  ros::CallbackQueue queue_;
  ros::SteadyTimer timer_;
  ros::AsyncSpinner spinner_;
};

}  // namespace curtain_ros
