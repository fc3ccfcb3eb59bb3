// SPDX-License-Identifier: BSD-3-Clause
#include "ros/curtain_node.h"

#include <ros/console.h>
#include <ros/init.h>

namespace curtain_ros {

namespace {

curtain::Simulator makeSimulator(const curtain::Scene& scene, const std::string& private_space) {
  try {
    return curtain::Simulator(scene);
  } catch (const std::invalid_argument& e) {  // a mesh that can't be read, a line that is too short
    throw ParameterError("can't start, problem(s) with " + private_space + "/scene:\n  " + e.what());
  }
}

std::unique_ptr<RoscppWatch> makeWatch(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                       const Inputs& inputs) {
  std::vector<std::string> topics = inputs.topics();
  for (const char* tf : {"/tf", "/tf_static"}) topics.push_back(node.resolveName(tf));
  for (const char* own : {"handles/feedback", "open"}) topics.push_back(private_node.resolveName(own));
  return std::make_unique<RoscppWatch>(private_node.getNamespace(), topics);
}

}  // namespace

CurtainNode::CurtainNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : CurtainNode(node, private_node, readParameters(private_node)) {}

CurtainNode::CurtainNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                         const ParameterReading& reading)
    : simulator_(makeSimulator(reading.scene, private_node.getNamespace())),
      frames_(node, reading.node.world_frame),
      inputs_(node, frames_),
      obstacles_(reading.scene, reading.node.obstacle_timeout, frames_),
      hands_(private_node, reading.node.grasp_timeout, frames_, inputs_),
      outputs_(private_node, reading.node, simulator_, frames_),
      clock_(reading.scene.solver.frame_rate, reading.node.max_catch_up),
      snapshots_(reading.node.snapshot_file, reading.node.snapshot_period),
      diagnostics_(node, private_node, reading.node.diagnostic_period, clock_.simulated()) {
  if (reading.node.handles) handles_ = std::make_unique<Handles>(private_node, reading.node, simulator_, inputs_);
  if (!reading.scene.rail.path.empty()) opening_ = std::make_unique<OpenCurtain>(private_node, inputs_);
  if (!reading.scene.tie_back.empty()) tie_backs_ = std::make_unique<TieBacks>(private_node, reading.scene);
  if (reading.node.watch_roscpp) watch_ = makeWatch(node, private_node, inputs_);
  if (snapshots_.restore(simulator_)) {
    obstacles_.resume(simulator_);
    hands_.restart(simulator_, "the curtain goes on from a snapshot");
  } else {
    obstacles_.restart(simulator_);
  }
  const curtain::Scene& scene = simulator_.scene();
  ROS_INFO_STREAM("curtain of " << simulator_.rows() << " x " << simulator_.columns() << " nodes, "
                                << scene.obstacles.size() << " obstacle(s), method "
                                << curtain::toString(scene.solver.method) << ", " << scene.solver.frame_rate
                                << " frames/s in '" << frames_.world() << "'");
  thread_ = std::thread([this] { run(); });
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
  while (!stopping()) {
    const std::int64_t now = clock_.now();
    if (now > 0) makeFrames(now);
    if (diagnostics_.wanted()) diagnostics_.answer(health());
    waitForNextFrame();
  }
}

void CurtainNode::makeFrames(std::int64_t now) {
  const StepClock::Due due = clock_.update(now);
  if (due.restarted) {
    frames_.clear();
    restart();
  }
  for (int i = 0; i < due.frames && !stopping(); ++i) makeFrame(clock_.take(), i + 1 == due.frames);
  clock_.logLosses(simulator_.statistics().step_seconds);
  if (due.frames > 0) snapshots_.update(simulator_, now);
}

void CurtainNode::makeFrame(const ros::Time& stamp, bool latest) {
  inputs_.apply(simulator_);
  if (opening_) opening_->apply(simulator_);
  if (tie_backs_) tie_backs_->apply(simulator_);
  obstacles_.update(simulator_, ros::Time::now());
  hands_.apply(simulator_, ros::Time::now());
  simulator_.step();
  if (!simulator_.statistics().finite) {
    ROS_ERROR_THROTTLE(2.0, "the state is not finite any more: the curtain starts again from the scene");
    ++not_finite_;
    restart();
    return;
  }
  outputs_.publish(stamp, nodeStatistics(), latest);
  if (handles_) handles_->update(simulator_);
  if (opening_) opening_->update(simulator_);
  hands_.update(simulator_);
  diagnostics_.frameMade();
}

void CurtainNode::restart() {
  ++restarts_;
  hands_.restart(simulator_, "the curtain started again");
  simulator_.reset();
  if (opening_) opening_->restart();
  inputs_.restart();
  obstacles_.restart(simulator_);
}

curtain_sim::Statistics CurtainNode::nodeStatistics() const {
  curtain_sim::Statistics statistics;
  statistics.restarts = restarts_;
  statistics.not_finite = not_finite_;
  clock_.count(statistics);
  inputs_.count(statistics);
  obstacles_.count(statistics);
  snapshots_.count(statistics);
  if (watch_) {
    statistics.dropped_queue = watch_->droppedMessages();
    statistics.masters_lost = watch_->mastersLost();
  }
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
  health.master_watched = watch_ != nullptr;
  health.master_answers = !watch_ || watch_->masterAnswers();
  return health;
}

void CurtainNode::waitForNextFrame() {
  std::unique_lock<std::mutex> lock(stop_mutex_);
  stop_signal_.wait_for(lock, clock_.untilNext(), [this] { return stop_; });
}

bool CurtainNode::stopping() {
  const std::lock_guard<std::mutex> lock(stop_mutex_);
  return stop_;
}

}  // namespace curtain_ros
