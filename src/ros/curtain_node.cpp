// SPDX-License-Identifier: BSD-3-Clause
#include "ros/curtain_node.h"

#include <ros/console.h>
#include <ros/init.h>

#include <regex>

#include "ros/tuning/live_values.h"

namespace curtain_ros {

namespace {

curtain::Simulator makeSimulator(const curtain::Scene& scene, const std::string& private_space) {
  try {
    return curtain::Simulator(scene);
  } catch (const std::invalid_argument& e) {  // meshes that can't be read, a line that is too short
    const std::string lines = std::regex_replace(e.what(), std::regex("\n"), "\n  ");
    throw ParameterError("can't start, problem(s) with " + private_space + "/scene:\n  " + lines);
  }
}

}  // namespace

CurtainNode::CurtainNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : CurtainNode(node, private_node, readParameters(private_node)) {}

CurtainNode::CurtainNode(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                         const ParameterReading& reading)
    : params_(reading.node),
      simulator_(makeSimulator(reading.scene, private_node.getNamespace())),
      frames_(node, reading.node.world_frame),
      inputs_(node, frames_),
      obstacles_(reading.scene, reading.node.obstacle_timeout, frames_),
      hands_(private_node, reading.node.grasp_timeout, frames_, inputs_),
      outputs_(private_node, reading.node, simulator_, frames_),
      sensors_(node, private_node, reading.points, simulator_, frames_, inputs_),
      clock_(reading.scene.solver.frame_rate, reading.node.max_catch_up, reading.node.publish_clock),
      lock_step_(reading.node.start_paused),
      snapshots_(reading.node.snapshot_file, reading.node.snapshot_period),
      calls_([this] { wake(); }),
      diagnostics_(node, private_node, reading.node.diagnostic_period, clock_.follows()) {
  if (reading.node.handles) handles_ = std::make_unique<Handles>(private_node, reading.node, simulator_, inputs_);
  for (const curtain::Simulator::LayerColumns& layer : simulator_.layers()) {
    if (!simulator_.railPoints(1.0, layer.name).empty())
      openings_.push_back(std::make_unique<OpenCurtain>(private_node, inputs_, layer.name));
  }
  if (!reading.scene.tie_back.empty()) tie_backs_ = std::make_unique<TieBacks>(private_node, reading.scene);
  if (snapshots_.restore(simulator_)) {
    obstacles_.resume(simulator_);
    hands_.restart(simulator_, "the curtain goes on from a snapshot");
    applyRates();
  } else {
    obstacles_.restart(simulator_);
  }
  if (reading.node.publish_clock) {
    clock_publisher_ = std::make_unique<ClockPublisher>();
    clock_.begin(simulator_.time());
    clock_publisher_->publish(clock_.rosTime());
  }
  startServices(private_node);
  if (reading.node.watch_roscpp) startWatch(node, private_node);
  const curtain::Scene& scene = simulator_.scene();
  ROS_INFO_STREAM("curtain of " << simulator_.rows() << " x " << simulator_.columns() << " nodes, "
                                << scene.obstacles.size() << " obstacle(s), method "
                                << curtain::toString(scene.solver.method) << ", " << scene.solver.frame_rate
                                << " frames/s in '" << frames_.world() << "'");
  thread_ = std::thread([this] { run(); });
}

void CurtainNode::startServices(const ros::NodeHandle& private_node) {
  ControlServices::Actions control;
  control.reset = [this] { restart("the curtain was reset"); };
  control.set_paused = [this](bool paused) { setPaused(paused); };
  control.lock_step = &lock_step_;
  if (clock_.follows()) {
    control.no_step = "the node follows /clock, which others drive: step that, or set ~publish_clock";
  }
  control_services_ = std::make_unique<ControlServices>(private_node, calls_, control);

  FileServices::Actions file;
  file.restore = [this](const std::string& snapshot) { return restore(snapshot); };
  Tuning::Actions tuning;
  tuning.apply = [this](const curtain_sim::CurtainConfig& values) { tune(values); };
  tuning.present = [this] { return liveValues(simulator_.scene(), params_); };
  tuning.set_material = [this](const curtain_sim::SetMaterialRequest& wanted) {
    return applyMaterial(wanted, simulator_);
  };
  tuning_ = std::make_unique<Tuning>(private_node, calls_, tuning);
  file_services_ = std::make_unique<FileServices>(private_node, calls_, simulator_, file);
  measure_services_ = std::make_unique<MeasureServices>(private_node, calls_, simulator_, frames_.world());
  ties_ = std::make_unique<Ties>(private_node, params_.grasp_timeout,
                                 Ties::Surroundings{calls_, simulator_, frames_, [this] { return clock_.rosTime(); }});
}

void CurtainNode::startWatch(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  std::vector<std::string> topics = inputs_.topics(), services;
  for (const char* tf : {"/tf", "/tf_static"}) topics.push_back(node.resolveName(tf));
  topics.push_back(private_node.resolveName("handles/feedback"));
  for (const auto& opening : openings_) topics.push_back(opening->topic());
  for (const char* own : {"reset", "pause", "step", "save", "load", "export_mesh", "distance", "attach", "detach",
                          "set_material", "set_parameters"})
    services.push_back(private_node.resolveName(own));
  for (const std::string& topic : sensors_.topics()) topics.push_back(topic);
  if (tie_backs_) services.push_back(private_node.resolveName("tie_back"));
  // dynamic_reconfigure's values are parameters, too: of now, not of the start.
  watch_ = std::make_unique<RoscppWatch>(private_node.getNamespace(), topics, services, [this] { tuning_->refresh(); });
}

CurtainNode::~CurtainNode() { stop(); }

// Frames, and messages of what became of them, come at an end; then the answers to those who wait for some.
void CurtainNode::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(stop_mutex_);
    stop_ = true;
  }
  stop_signal_.notify_all();
  thread_.join();
  calls_.close();
  lock_step_.end(kStops);
  snapshots_.finish(simulator_);
}

void CurtainNode::run() {
  while (!stopping()) {
    calls_.work();
    const std::int64_t now = clock_.now();
    if (now > 0) lock_step_.paused() ? pause(now) : makeFrames(now);
    if (lock_step_.asked()) makeAskedFrame();
    if (diagnostics_.wanted()) diagnostics_.answer(health());
    if (!lock_step_.asked()) waitForNextFrame();
  }
}

void CurtainNode::makeFrames(std::int64_t now) {
  const StepClock::Due due = clock_.update(now);
  if (due.restarted) {
    frames_.clear();
    restart("/clock jumped back");
  }
  for (int i = 0; i < due.frames && !stopping(); ++i) makeFrame(clock_.advance(), i + 1 == due.frames);
  clock_.logLosses();
  if (due.frames > 0) snapshots_.update(simulator_, clock_.nodeTime());
}

// Messages are taken all the same: mailboxes are small.
void CurtainNode::pause(std::int64_t now) {
  const StepClock::Due due = clock_.pass(now);
  if (due.restarted) {
    frames_.clear();
    restart("/clock jumped back");
  }
  if (due.frames == 0) return;
  applyInputs();
  outputs_.showAgain(clock_.rosTime());
  if (!lock_step_.asked()) sensors_.showAgain(clock_.rosTime());  // not between frames that were asked for
}

void CurtainNode::makeAskedFrame() {
  const ros::Time stamp = clock_.stampInPause();
  makeFrame(stamp, lock_step_.lastOfRequest());
  LockStep::Answer made;
  made.frame = static_cast<std::uint64_t>(simulator_.statistics().frames);
  made.simulated_time = simulator_.time();
  made.stamp = stamp;
  lock_step_.made(made);
  snapshots_.update(simulator_, clock_.nodeTime());
}

void CurtainNode::applyInputs() {
  inputs_.apply(simulator_);
  for (const auto& opening : openings_) opening->apply(simulator_);
  if (tie_backs_) tie_backs_->apply(simulator_);
  sensors_.apply();
}

void CurtainNode::makeFrame(const ros::Time& stamp, bool latest) {
  applyInputs();
  obstacles_.update(simulator_, clock_.rosTime());
  hands_.apply(simulator_, clock_.rosTime());
  ties_->apply();
  simulator_.step();
  if (!simulator_.statistics().finite) {
    ROS_ERROR_THROTTLE(2.0, "the state is not finite any more: the curtain starts again from the scene");
    ++not_finite_;
    restart("the state was not finite any more");
    return;
  }
  if (clock_publisher_) clock_publisher_->publish(stamp);  // first: nobody gets a stamp ahead of the clock
  outputs_.publish(stamp, nodeStatistics(), latest);
  showSensors(stamp, latest);
  if (handles_) handles_->update(simulator_);
  for (const auto& opening : openings_) opening->update(simulator_);
  hands_.update(simulator_);
  ties_->update();
  diagnostics_.frameMade();
}

// Frames that are made because time has passed wait for no view. Those that are asked for have their views, at the rate
// of simulated time, and the last one has one in any case, before the answer.
void CurtainNode::showSensors(const ros::Time& stamp, bool latest) {
  sensors_.tick();
  if (!lock_step_.asked()) {
    if (latest) sensors_.publish(stamp, clock_.rosTime());
    return;
  }
  sensors_.finish();  // of the pause until now
  if (latest) sensors_.hurry();
  sensors_.publish(stamp, clock_.rosTime());
  sensors_.finish();
}

void CurtainNode::restart(const std::string& why) {
  ++restarts_;
  hands_.restart(simulator_, "the curtain started again");
  ties_->restart();
  simulator_.reset();
  lock_step_.end(why);
  for (const auto& opening : openings_) opening->restart();
  inputs_.restart();
  obstacles_.restart(simulator_);
}

// Another run goes on here: what belonged to the one until now ends as in restart().
std::vector<curtain::Problem> CurtainNode::restore(const std::string& snapshot) {
  std::vector<curtain::Problem> problems = simulator_.restore(snapshot);
  if (!problems.empty()) return problems;
  ++restarts_;
  hands_.restart(simulator_, "a snapshot was loaded");
  ties_->restart();
  lock_step_.end("a snapshot was loaded");
  for (const auto& opening : openings_) opening->restart();
  inputs_.restart();
  obstacles_.resume(simulator_);
  applyRates();
  tuning_->refresh();
  return problems;
}

void CurtainNode::setPaused(bool paused) {
  if (lock_step_.paused() && !paused) clock_.resume();
  lock_step_.setPaused(paused);
}

void CurtainNode::tune(const curtain_sim::CurtainConfig& values) {
  const std::vector<curtain::Problem> problems = applyLiveValues(values, simulator_, params_);
  if (!problems.empty()) inputs_.refuse("~set_parameters", problems);
  obstacles_.setTimeout(params_.obstacle_timeout);
  applyRates();
}

// The frame rate may have changed, and rates of the outputs are shares of it.
void CurtainNode::applyRates() {
  const double rate = simulator_.scene().solver.frame_rate;
  clock_.setRate(rate);
  outputs_.tune(params_, rate);
  sensors_.setFrameRate(rate);
  if (handles_) handles_->setFrameRate(rate);
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
  health.paused = lock_step_.paused();
  health.obstacles = obstacles_.health(simulator_);
  health.snapshots = snapshots_.health();
  health.last_drop = inputs_.lastDrop();
  health.viewer_error = outputs_.viewerError();
  health.sensor_error = sensors_.error();
  health.master_watched = watch_ != nullptr;
  health.master_answers = !watch_ || watch_->masterAnswers();
  return health;
}

void CurtainNode::waitForNextFrame() {
  std::unique_lock<std::mutex> lock(stop_mutex_);
  stop_signal_.wait_for(lock, clock_.untilNext(), [this] { return stop_ || woken_; });
  woken_ = false;
}

// A call waits for the simulation thread. Any thread.
void CurtainNode::wake() {
  {
    const std::lock_guard<std::mutex> lock(stop_mutex_);
    woken_ = true;
  }
  stop_signal_.notify_all();
}

bool CurtainNode::stopping() {
  const std::lock_guard<std::mutex> lock(stop_mutex_);
  return stop_;
}

}  // namespace curtain_ros
