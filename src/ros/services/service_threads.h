// SPDX-License-Identifier: BSD-3-Clause
//
// Threads that serve services alone. Callbacks of services wait for the simulation thread, or for a disk: in the queue
// that the program or the nodelet manager spins they would hold up the topics.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>

#include <cstdint>

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

  ServiceThreads(const ServiceThreads&) = delete;
  ServiceThreads& operator=(const ServiceThreads&) = delete;

  /// What is advertised by this handle is served here. It must be shut down before this is destroyed.
  ros::NodeHandle& node() { return node_; }

 private:
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::AsyncSpinner spinner_;
};

}  // namespace curtain_ros
