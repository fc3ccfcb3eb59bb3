// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: the wiring of a curtain in ROS. A thread of its own makes the frames:
//
//   wait for the clock -> calls of services -> messages -> obstacle frames -> step -> publish
//
// Callbacks run in whoever spins the given handles' queue and only leave messages; no lock is held while solving or
// publishing. Services, diagnostics, snapshots and the watch on roscpp, which may have to wait for others, have threads
// of their own. The same class serves the node program and the nodelet. The rooms, each knows only those above it:
//
//   parameters  time  frames                      what the node is told; when frames are due; poses on tf2
//   inputs  obstacles  outputs  snapshots  watch  what it does; watch, which looks into roscpp, can be switched off
//   opening  hands  sensors  health  services     the rail's drive and tie-backs; grasps; points and depth images; what
//                                                 it says of itself; is asked for
//   tuning  ties                                  what is changed meanwhile; what is tied to frames
#pragma once

#include <ros/node_handle.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <thread>

#include "curtain_sim/simulator.h"
#include "ros/frames/frames.h"
#include "ros/hands/hands.h"
#include "ros/health/diagnostics.h"
#include "ros/inputs/handles.h"
#include "ros/inputs/inputs.h"
#include "ros/obstacles/obstacle_tracker.h"
#include "ros/opening/open_curtain.h"
#include "ros/opening/tie_backs.h"
#include "ros/outputs/outputs.h"
#include "ros/parameters/parameters.h"
#include "ros/sensors/sensor_outputs.h"
#include "ros/services/calls.h"
#include "ros/services/control_services.h"
#include "ros/services/file_services.h"
#include "ros/services/lock_step.h"
#include "ros/services/measure_services.h"
#include "ros/snapshots/snapshot_keeper.h"
#include "ros/ties/ties.h"
#include "ros/time/clock_publisher.h"
#include "ros/time/frame_clock.h"
#include "ros/tuning/tuning.h"
#include "ros/watch/roscpp_watch.h"

namespace curtain_ros {

class CurtainNode {
 public:
  /// Reads the parameters, builds the curtain and starts.
  ///   node          wind_source and drag_force are in its namespace
  ///   private_node  parameters, what is published, services, actions; also its name on /diagnostics
  /// Throws ParameterError with every problem.
  CurtainNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

  ~CurtainNode();

  /// Makes no more frames, answers callers of services that wait for some, and writes the last snapshot where one is
  /// asked for: within the computing time of a frame, and what the disk takes. Asks nobody else: what remains for the
  /// destructor may have to wait for the ROS master.
  void stop();

  CurtainNode(const CurtainNode&) = delete;
  CurtainNode& operator=(const CurtainNode&) = delete;

 private:
  CurtainNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node, const ParameterReading& reading);

  void run();
  void makeFrames(std::int64_t now);
  void pause(std::int64_t now);
  void makeFrame(const ros::Time& stamp, bool latest);
  void makeAskedFrame();
  void showSensors(const ros::Time& stamp, bool latest);
  void applyInputs();
  void restart(const std::string& why);
  std::vector<curtain::Problem> restore(const std::string& snapshot);
  void setPaused(bool paused);
  void tune(const curtain_sim::CurtainConfig& values);
  void applyRates();
  void startServices(const ros::NodeHandle& private_node);
  void startWatch(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  void waitForNextFrame();
  void wake();
  bool stopping();
  curtain_sim::Statistics nodeStatistics() const;
  Health health() const;

  NodeParams params_;  // as they are now
  curtain::Simulator simulator_;
  Frames frames_;
  Inputs inputs_;
  ObstacleTracker obstacles_;
  Hands hands_;
  Outputs outputs_;
  SensorOutputs sensors_;
  std::unique_ptr<Handles> handles_;                    // none unless ~handles
  std::vector<std::unique_ptr<OpenCurtain>> openings_;  // of cloths on rails
  std::unique_ptr<TieBacks> tie_backs_;                 // none without one in the scene
  FrameClock clock_;
  std::unique_ptr<ClockPublisher> clock_publisher_;  // none unless ~publish_clock
  LockStep lock_step_;
  SnapshotKeeper snapshots_;
  std::uint32_t restarts_ = 0;
  std::uint32_t not_finite_ = 0;

  std::mutex stop_mutex_;
  std::condition_variable stop_signal_;
  bool stop_ = false;
  bool woken_ = false;
  Calls calls_;
  std::unique_ptr<ControlServices> control_services_;
  std::unique_ptr<Tuning> tuning_;
  std::unique_ptr<FileServices> file_services_;
  std::unique_ptr<MeasureServices> measure_services_;
  std::unique_ptr<Ties> ties_;
  std::unique_ptr<RoscppWatch> watch_;  // none unless ~watch_roscpp
  Diagnostics diagnostics_;
  std::thread thread_;
};

}  // namespace curtain_ros
