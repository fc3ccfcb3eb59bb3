// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: the wiring of a curtain in ROS. A thread of its own makes the frames:
//
//   wait for the clock -> letters -> obstacle frames -> step -> publish
//
// Callbacks run in whoever spins the given handles' queue and only leave letters; no lock is held while solving or
// publishing. What asks others and may have to wait, the watch on the master and the diagnostics, has threads of its
// own. The same class serves the node program and the nodelet.
#pragma once

#include <ros/node_handle.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "curtain_sim/Statistics.h"
#include "curtain_sim/simulator.h"
#include "ros/frames/frames.h"
#include "ros/health/diagnostics.h"
#include "ros/health/health.h"
#include "ros/inputs/handles.h"
#include "ros/inputs/inputs.h"
#include "ros/obstacles/obstacle_tracker.h"
#include "ros/outputs/outputs.h"
#include "ros/outputs/plan_log.h"
#include "ros/parameters/parameters.h"
#include "ros/snapshots/snapshot_keeper.h"
#include "ros/time/node_clock.h"
#include "ros/time/periodic.h"
#include "ros/time/step_clock.h"
#include "ros/watch/master_watch.h"
#include "ros/watch/queue_watch.h"

namespace curtain_ros {

class CurtainNode {
 public:
  /// Reads the parameters, builds the curtain and starts.
  ///   node          wind_source and drag_force are in its namespace
  ///   private_node  parameters, ~state, ~mesh, ~markers, ~contacts, ~handles; also its name on /diagnostics
  /// Throws ParameterError with every problem.
  CurtainNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  ~CurtainNode() { stop(); }

  /// Makes no more frames, and writes the last snapshot where one is asked for: within the computing time of a frame,
  /// and what the disk takes. Asks nobody else: what remains for the destructor may have to wait for the ROS master.
  void stop();

  CurtainNode(const CurtainNode&) = delete;
  CurtainNode& operator=(const CurtainNode&) = delete;

 private:
  CurtainNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node, ParameterReading reading);

  void run();
  void makeFrame(const ros::Time& stamp, bool latest);
  void restart();
  void waitForNextFrame();
  void warnOfDroppedFrames();
  bool stopping();
  void measureSpeed();
  curtain_sim::Statistics nodeStatistics() const;
  Health health() const;

  curtain::Simulator simulator_;
  Frames frames_;
  Inputs inputs_;
  ObstacleTracker obstacles_;
  Outputs outputs_;
  std::unique_ptr<Handles> handles_;  // none unless ~handles
  PlanLog plan_log_;
  NodeClock clock_;
  StepClock step_clock_;

  std::uint32_t restarts_ = 0;
  std::uint32_t not_finite_ = 0;
  std::uint32_t clock_jumps_back_ = 0;
  std::uint32_t warned_set_back_ = 0;
  std::uint64_t warned_dropped_ = 0;
  // Real-time factor: simulated and monotonic time at the start of the stretch that is measured now.
  std::int64_t measured_frames_ = 0;
  ros::SteadyTime measured_since_;
  double real_time_factor_ = 0.0;

  SnapshotKeeper snapshots_;
  HealthDesk desk_;
  MasterWatch master_;
  QueueWatch queues_;

  std::mutex stop_mutex_;
  std::condition_variable stop_signal_;
  bool stop_ = false;
  std::thread thread_;
  std::unique_ptr<Periodic> watches_;
  std::unique_ptr<Diagnostics> diagnostics_;
};

}  // namespace curtain_ros
