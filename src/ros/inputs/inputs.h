// SPDX-License-Identifier: BSD-3-Clause
//
// Wind sources and user forces that come as messages. Callbacks only leave the message in a mailbox; the simulation
// thread checks, transforms and applies it at the start of a frame. A bad message is dropped, counted and warned of
// (throttled).
#pragma once

#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "curtain_sim/DragForce.h"
#include "curtain_sim/Statistics.h"
#include "curtain_sim/WindSource.h"
#include "curtain_sim/simulator.h"
#include "ros/frames/frames.h"
#include "ros/inputs/mailbox.h"
#include "ros/inputs/moving_winds.h"

namespace curtain_ros {

class Inputs {
 public:
  /// Subscribes wind_source and drag_force. frames must outlive this.
  Inputs(ros::NodeHandle node, Frames& frames);

  /// Leaves a user force as if it came on the topic. Any thread.
  void post(const curtain_sim::DragForce::ConstPtr& message) { drags_.mailbox.post(message); }

  /// Counts a message that another input of the node took, or refused. Simulation thread.
  void countAccepted() { ++accepted_; }
  void refuse(const std::string& message, const std::vector<curtain::Problem>& problems);

  /// Applies what arrived, in order, moves winds with their frames, and removes sources whose lifetime is over.
  /// Simulation thread.
  void apply(curtain::Simulator& simulator);

  /// A new run begins: the simulator has gone back to the scene's winds and drags. Simulation thread.
  void restart() { carried_.clear(); }

  /// Messages taken and dropped since construction. Simulation thread.
  void count(curtain_sim::Statistics& statistics) const;

  /// Which message was dropped last and why; empty: none. Simulation thread.
  const std::string& lastDrop() const { return last_drop_; }

  /// Resolved names of the topics. Any thread.
  std::vector<std::string> topics() const { return {winds_.subscriber.getTopic(), drags_.subscriber.getTopic()}; }

 private:
  template <typename Message>
  struct Topic {
    const char* name;
    Mailbox<boost::shared_ptr<const Message>> mailbox;
    // Messages whose frame may still arrive, and those behind them: only while the tf2 listener is young.
    std::deque<boost::shared_ptr<const Message>> waiting;
    ros::Subscriber subscriber;
  };

  template <typename Message>
  void subscribe(ros::NodeHandle& node, Topic<Message>& topic);
  template <typename Message>
  void work(Topic<Message>& topic, curtain::Simulator& simulator);
  /// False: not yet, try again next frame.
  template <typename Message>
  bool handle(const char* topic, const Message& message, curtain::Simulator& simulator);
  void drop(const std::string& message, const std::string& why);
  void warnOfOverflow();

  void note(const curtain_sim::WindSource& message) { carried_.note(message); }
  void note(const curtain_sim::DragForce&) {}

  Frames& frames_;
  MovingWinds carried_;
  Topic<curtain_sim::WindSource> winds_;
  Topic<curtain_sim::DragForce> drags_;
  std::uint64_t accepted_ = 0;
  std::uint32_t invalid_ = 0;
  std::uint32_t untransformed_ = 0;
  std::uint64_t warned_overflow_ = 0;
  std::string last_drop_;
};

}  // namespace curtain_ros
