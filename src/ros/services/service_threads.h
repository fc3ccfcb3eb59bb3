// SPDX-License-Identifier: BSD-3-Clause
//
// Threads that serve services alone. Callbacks of services wait for the simulation thread, or for a disk: in the queue
// that the program or the nodelet manager spins they would hold up the topics.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <functional>
#include <utility>

namespace curtain_ros {

class ServiceThreads {
 public:
  /// count  calls that are served at a time, >= 1; others wait for their turn
  ServiceThreads(const ros::NodeHandle& private_node, std::uint32_t count)
      : node_(private_node), spinner_(count, &queue_) {
    node_.setCallbackQueue(&queue_);
  }

  /// Calls are served from now on.
  void start() { spinner_.start(); }
  /// None is any more; returns when those under way are. Threads that wait for calls end at once: left to themselves
  /// they look a tenth of a second later.
  void stop() {
    queue_.disable();
    spinner_.stop();
  }
  ~ServiceThreads() { stop(); }

  /// Has work done by one of the threads, among the calls.
  void post(std::function<void()> work) { queue_.addCallback(boost::make_shared<Work>(std::move(work))); }

  ServiceThreads(const ServiceThreads&) = delete;
  ServiceThreads& operator=(const ServiceThreads&) = delete;

  /// What is advertised by this handle is served here. It must be shut down before this is destroyed.
  ros::NodeHandle& node() { return node_; }

 private:
  class Work : public ros::CallbackInterface {
   public:
    explicit Work(std::function<void()> work) : work_(std::move(work)) {}
    CallResult call() override {
      work_();
      return Success;
    }

   private:
    std::function<void()> work_;
  };

  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::AsyncSpinner spinner_;
};

}  // namespace curtain_ros
