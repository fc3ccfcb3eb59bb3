// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: wind sources and user forces that come as messages. Callbacks only leave the message in a mailbox; the
// simulation thread judges, transforms and applies them at the start of a frame. A bad message is dropped, counted
// and warned of (throttled), and the node goes on.
#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "curtain_sim/DragForce.h"
#include "curtain_sim/WindSource.h"
#include "curtain_sim/simulator.h"
#include "ros/frames/frames.h"
#include "ros/inputs/mailbox.h"

namespace curtain_ros {

class Inputs {
 public:
  /// Subscribes wind_source and drag_force. frames must outlive this.
  Inputs(ros::NodeHandle node, Frames& frames);

  /// Leaves a user force as if it came on the topic. Any thread.
  void post(const curtain_sim::DragForce::ConstPtr& message) { drags_.post(message); }

  /// Applies what arrived, in order, and takes away what is over. Simulation thread.
  void apply(curtain::Simulator& simulator);

  /// Messages taken and dropped since construction. Simulation thread.
  std::uint64_t taken() const { return taken_; }
  std::uint32_t invalid() const { return invalid_; }
  std::uint32_t untransformed() const { return untransformed_; }
  std::uint32_t overflowed() const { return static_cast<std::uint32_t>(winds_.lost() + drags_.lost()); }

  /// Which message was dropped last and why; empty: none. Simulation thread.
  const std::string& lastDrop() const { return last_drop_; }

  /// Names of the topics. Any thread.
  std::vector<std::string> topics() const { return {wind_subscriber_.getTopic(), drag_subscriber_.getTopic()}; }

 private:
  /// False: not yet, try again next frame.
  bool handle(const curtain_sim::WindSource& message, curtain::Simulator& simulator);
  bool handle(const curtain_sim::DragForce& message, curtain::Simulator& simulator);

  template <typename Message>
  void work(std::deque<boost::shared_ptr<const Message>>& waiting, curtain::Simulator& simulator);
  void drop(const char* topic, const std::string& id, const std::vector<curtain::Problem>& problems);
  void warnOfOverflow();
  bool findFrame(const char* topic, const std::string& id, const std::string& frame, FrameLookup& lookup);

  Frames& frames_;
  Mailbox<curtain_sim::WindSource::ConstPtr> winds_;
  Mailbox<curtain_sim::DragForce::ConstPtr> drags_;
  // Messages whose frame may still arrive, and those behind them: only while the tf2 listener is young.
  std::deque<curtain_sim::WindSource::ConstPtr> waiting_winds_;
  std::deque<curtain_sim::DragForce::ConstPtr> waiting_drags_;
  std::uint64_t taken_ = 0;
  std::uint32_t invalid_ = 0;
  std::uint32_t untransformed_ = 0;
  std::uint64_t warned_overflow_ = 0;
  std::string last_drop_;
  ros::Subscriber wind_subscriber_;
  ros::Subscriber drag_subscriber_;
};

}  // namespace curtain_ros
