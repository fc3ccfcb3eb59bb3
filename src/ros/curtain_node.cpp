// SPDX-License-Identifier: BSD-3-Clause
#include "ros/curtain_node.h"

#include <ros/console.h>
#include <ros/init.h>

#include <chrono>
#include <utility>

#include "ros/outputs/to_messages.h"

namespace curtain_ros {

namespace {

// How often a clock that others drive is looked at.
constexpr auto kSimulatedClockPoll = std::chrono::milliseconds(1);
constexpr double kFactorPeriod = 1.0;  // [s] that the real-time factor is measured over
constexpr double kWatchPeriod = 1.0;   // [s] between two looks at the master and at roscpp's queues
constexpr double kWarnPeriod = 5.0;    // [s] between warnings of one kind

curtain::Simulator makeSimulator(const curtain::Scene& scene, const std::string& private_space) {
  try {
    return curtain::Simulator(scene);
  } catch (const std::invalid_argument& e) {
    throw ParameterError("can't start, problem(s) with " + private_space + "/scene:\n  " + e.what());
  }
}

// What the node listens to, as roscpp calls it.
std::vector<std::string> inputTopics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                     const Inputs& inputs) {
  std::vector<std::string> topics = inputs.topics();
  for (const char* tf : {"/tf", "/tf_static"}) topics.push_back(node.resolveName(tf));
  topics.push_back(private_node.resolveName("handles/feedback"));
  return topics;
}

}  // namespace

CurtainNode::CurtainNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : CurtainNode(node, private_node, readParameters(private_node)) {}

CurtainNode::CurtainNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node, ParameterReading reading)
    : simulator_(makeSimulator(reading.scene, private_node.getNamespace())),
      frames_(node, reading.node.world_frame),
      inputs_(node, frames_),
      obstacles_(reading.scene, reading.node.obstacle_timeout, frames_),
      outputs_(private_node, reading.node, simulator_, frames_),
      step_clock_(reading.scene.solver.frame_rate, reading.node.max_catch_up),
      snapshots_(reading.node.snapshot_file, reading.node.snapshot_period),
      master_(private_node.getNamespace()),
      queues_(inputTopics(node, private_node, inputs_)) {
  if (reading.node.handles) handles_ = std::make_unique<Handles>(private_node, reading.node, simulator_, inputs_);
  if (snapshots_.restore(simulator_)) {
    obstacles_.resume(simulator_);
  } else {
    obstacles_.restart(simulator_);
  }
  const curtain::Scene& scene = simulator_.scene();
  ROS_INFO_STREAM("curtain of " << simulator_.rows() << " x " << simulator_.columns() << " nodes, "
                                << scene.obstacles.size() << " obstacle(s), method "
                                << curtain::toString(scene.solver.method) << ", " << scene.solver.frame_rate
                                << " frames/s in '" << frames_.world() << "'");
  thread_ = std::thread([this] { run(); });
  watches_ = std::make_unique<Periodic>(kWatchPeriod, [this] {
    queues_.look();
    master_.look();
  });
  diagnostics_ = std::make_unique<Diagnostics>(node, private_node, reading.node.diagnostic_period, clock_.simulated(),
                                               desk_, master_);
}

void CurtainNode::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(stop_mutex_);
    stop_ = true;
  }
  stop_signal_.notify_all();
  thread_.join();
  snapshots_.finish(simulator_);
}

void CurtainNode::run() {
  measured_since_ = ros::SteadyTime::now();
  while (!stopping()) {
    const std::int64_t now = clock_.now();
    if (now > 0) {
      const StepClock::Due due = step_clock_.update(now);
      if (due.restarted) {
        ROS_WARN("the clock jumped back: the curtain goes back to its start");
        ++clock_jumps_back_;
        frames_.clear();
        restart();
      }
      for (int i = 0; i < due.frames && !stopping(); ++i) {
        makeFrame(clock_.stampOf(step_clock_.take()), i + 1 == due.frames);
      }
      warnOfDroppedFrames();
      if (due.frames > 0) snapshots_.update(simulator_, now);
    }
    if (desk_.wanted()) desk_.answer(health());
    waitForNextFrame();
  }
}

void CurtainNode::makeFrame(const ros::Time& stamp, bool latest) {
  inputs_.apply(simulator_);
  obstacles_.update(simulator_, ros::Time::now());
  simulator_.step();
  if (!simulator_.statistics().finite) {
    ROS_ERROR_THROTTLE(2.0, "the state is not finite any more: the curtain goes back to its start");
    ++not_finite_;
    restart();
    return;
  }
  plan_log_.update(simulator_);
  measureSpeed();
  outputs_.publish(stamp, nodeStatistics(), latest);
  if (handles_) handles_->update(simulator_);
  desk_.frameMade(ros::SteadyTime::now());
}

void CurtainNode::restart() {
  ++restarts_;
  simulator_.reset();
  obstacles_.restart(simulator_);
  measured_frames_ = 0;
  measured_since_ = ros::SteadyTime::now();
  real_time_factor_ = 0.0;
}

void CurtainNode::warnOfDroppedFrames() {
  const std::uint64_t dropped = step_clock_.dropped();
  if (dropped > warned_dropped_) {
    ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "too late for " << dropped - warned_dropped_ << " frames: dropped ("
                                                          << dropped << " so far); a frame takes "
                                                          << 1e3 * simulator_.statistics().step_seconds << " ms");
  }
  warned_dropped_ = dropped;
  if (clock_.setBack() > warned_set_back_) {
    ROS_WARN("the computer's clock was set back: stamps go back with it, the curtain goes on");
  }
  warned_set_back_ = clock_.setBack();
}

void CurtainNode::measureSpeed() {
  ++measured_frames_;
  const double wall = (ros::SteadyTime::now() - measured_since_).toSec();
  if (wall >= kFactorPeriod) {
    real_time_factor_ = static_cast<double>(measured_frames_) / simulator_.scene().solver.frame_rate / wall;
    measured_frames_ = 0;
    measured_since_ = ros::SteadyTime::now();
  }
}

curtain_sim::Statistics CurtainNode::nodeStatistics() const {
  curtain_sim::Statistics statistics;
  statistics.real_time_factor = real_time_factor_;
  statistics.dropped_frames = step_clock_.dropped();
  statistics.restarts = restarts_;
  statistics.dropped_invalid = inputs_.invalid();
  statistics.dropped_untransformed = inputs_.untransformed();
  statistics.dropped_overflow = inputs_.overflowed();
  statistics.absent_obstacles = obstacles_.absent();
  statistics.not_finite = not_finite_;
  statistics.clock_jumps_back = clock_jumps_back_;
  statistics.clock_set_back = clock_.setBack();
  statistics.dropped_queue = queues_.dropped();
  statistics.messages_taken = inputs_.taken();
  statistics.late_poses = obstacles_.latePoses();
  statistics.early_poses = obstacles_.earlyPoses();
  statistics.obstacles_lost = obstacles_.lost();
  statistics.masters_lost = master_.lost();
  const SnapshotCounts snapshots = snapshots_.counts();
  statistics.restored_time = snapshots.restored_time;
  statistics.snapshots_written = snapshots.written;
  statistics.snapshots_failed = snapshots.failed;
  statistics.snapshots_replaced = snapshots.replaced;
  return statistics;
}

Health CurtainNode::health() const {
  Health health;
  health.statistics = nodeStatistics();
  outputs_.count(health.statistics);
  toMessage(simulator_.statistics(), health.statistics);
  health.stretch_tolerance = simulator_.scene().solver.stretch_tolerance;
  health.frame_rate = simulator_.scene().solver.frame_rate;
  health.obstacles = obstacles_.health();
  health.snapshots = snapshots_.health();
  health.last_drop = inputs_.lastDrop();
  health.viewer_error = outputs_.viewerError();
  return health;
}

void CurtainNode::waitForNextFrame() {
  std::unique_lock<std::mutex> lock(stop_mutex_);
  const auto stop = [this] { return stop_; };
  if (clock_.simulated()) {
    stop_signal_.wait_for(lock, kSimulatedClockPoll, stop);
    return;
  }
  const std::int64_t left = step_clock_.next() - clock_.now();
  if (left > 0) stop_signal_.wait_for(lock, std::chrono::nanoseconds(left), stop);
}

bool CurtainNode::stopping() {
  const std::lock_guard<std::mutex> lock(stop_mutex_);
  return stop_;
}

}  // namespace curtain_ros
