// SPDX-License-Identifier: BSD-3-Clause
#include "ros/inputs.h"

#include <ros/console.h>

#include <algorithm>

#include "ros/conversions.h"

namespace curtain_ros {

using curtain_sim::DragForce;
using curtain_sim::WindSource;

namespace {

// Messages kept of a topic between two frames. Senders at 1 kHz for a frame of 1/20 s fit.
constexpr std::size_t kMailboxCapacity = 50;
constexpr std::uint32_t kQueueSize = 50;
constexpr double kWarnPeriod = 2.0;  // [s] between warnings of one kind
const char kWindTopic[] = "wind_source";
const char kDragTopic[] = "drag_force";

template <typename Params>
std::vector<std::string> idsOver(const std::vector<Params>& all, double time) {
  std::vector<std::string> ids;
  for (const Params& one : all) {
    if (one.end <= time) ids.push_back(one.id);
  }
  return ids;
}

}  // namespace

Inputs::Inputs(ros::NodeHandle node, Frames& frames)
    : frames_(frames), winds_(kMailboxCapacity), drags_(kMailboxCapacity) {
  const boost::function<void(const WindSource::ConstPtr&)> on_wind = [this](const WindSource::ConstPtr& message) {
    winds_.post(message);
  };
  const boost::function<void(const DragForce::ConstPtr&)> on_drag = [this](const DragForce::ConstPtr& message) {
    drags_.post(message);
  };
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  wind_subscriber_ = node.subscribe<WindSource>(kWindTopic, kQueueSize, on_wind, ros::VoidConstPtr(), hints);
  drag_subscriber_ = node.subscribe<DragForce>(kDragTopic, kQueueSize, on_drag, ros::VoidConstPtr(), hints);
}

void Inputs::apply(curtain::Simulator& simulator) {
  work(waiting_winds_, winds_.collect(), simulator);
  work(waiting_drags_, drags_.collect(), simulator);
  for (const std::string& id : idsOver(simulator.winds(), simulator.time())) simulator.removeWind(id);
  for (const std::string& id : idsOver(simulator.drags(), simulator.time())) simulator.removeDrag(id);
}

template <typename Message>
void Inputs::work(std::deque<boost::shared_ptr<const Message>>& waiting,
                  std::deque<boost::shared_ptr<const Message>> arrived, curtain::Simulator& simulator) {
  waiting.insert(waiting.end(), arrived.begin(), arrived.end());
  while (!waiting.empty() && handle(*waiting.front(), simulator)) waiting.pop_front();
}

bool Inputs::handle(const WindSource& message, curtain::Simulator& simulator) {
  std::vector<curtain::Problem> problems = checkHead(message);
  if (problems.empty() && message.action == WindSource::DELETE) {
    simulator.removeWind(message.id);
  } else if (problems.empty() && message.action == WindSource::DELETEALL) {
    simulator.clearWinds();
  } else if (problems.empty()) {
    FrameLookup frame;
    if (!findFrame(kWindTopic, message.id, message.header.frame_id, frame)) return !frame.may_come;
    curtain::WindParams wind;
    for (const curtain::WindParams& other : simulator.winds()) {
      if (other.id == message.id) wind = other;
    }
    problems = toWind(message, frame.pose, simulator.time(), wind);
    if (problems.empty()) problems = simulator.setWind(wind);
  }
  if (!problems.empty()) drop(kWindTopic, message.id, problems);
  return true;
}

bool Inputs::handle(const DragForce& message, curtain::Simulator& simulator) {
  std::vector<curtain::Problem> problems = checkHead(message);
  if (problems.empty() && message.action == DragForce::DELETE) {
    simulator.removeDrag(message.id);
  } else if (problems.empty() && message.action == DragForce::DELETEALL) {
    simulator.clearDrags();
  } else if (problems.empty()) {
    FrameLookup frame;
    if (!findFrame(kDragTopic, message.id, message.header.frame_id, frame)) return !frame.may_come;
    curtain::DragParams drag;
    problems = toDrag(message, frame.pose, simulator.time(), simulator.scene().cloth, drag);
    if (problems.empty()) problems = simulator.setDrag(drag);
  }
  if (!problems.empty()) drop(kDragTopic, message.id, problems);
  return true;
}

bool Inputs::findFrame(const char* topic, const std::string& id, const std::string& frame, FrameLookup& lookup) {
  lookup = frames_.lookup(frame);
  if (lookup.known) return true;
  if (lookup.may_come) return false;
  ++untransformed_;
  ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "dropped a message on " << topic << ", id '" << id << "': header.frame_id: '"
                                                                << frame << "' is not known in '" << frames_.world()
                                                                << "': " << lookup.error);
  return false;
}

void Inputs::drop(const char* topic, const std::string& id, const std::vector<curtain::Problem>& problems) {
  ++invalid_;
  ROS_WARN_STREAM_THROTTLE(kWarnPeriod,
                           "dropped a message on " << topic << ", id '" << id << "': " << curtain::describe(problems));
}

}  // namespace curtain_ros
