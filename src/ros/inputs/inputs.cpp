// SPDX-License-Identifier: BSD-3-Clause
#include "ros/inputs/inputs.h"

#include <ros/console.h>

#include <algorithm>
#include <boost/make_shared.hpp>

#include "ros/inputs/read_messages.h"

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

// Names that are too long to be taken are cut, but not so short that they would be taken: a mailbox full of megabytes
// would wait here as long as the clock stands.
template <typename Message>
boost::shared_ptr<const Message> withoutBulk(const boost::shared_ptr<const Message>& message) {
  if (std::max(message->id.size(), message->header.frame_id.size()) <= kLongestName) return message;
  const auto cut = boost::make_shared<Message>();
  *cut = *message;
  for (std::string* name : {&cut->id, &cut->header.frame_id}) {
    name->resize(std::min(name->size(), kLongestName + 1));
    name->shrink_to_fit();
  }
  return cut;
}

// Each source costs a look at the cloth in each substep: far more than anybody places, few enough for a frame.
constexpr std::size_t kMostSources = 256;

template <typename Params>
std::vector<curtain::Problem> checkRoom(const std::vector<Params>& all, const std::string& id) {
  const auto is_it = [&](const Params& one) { return one.id == id; };
  if (all.size() < kMostSources || std::any_of(all.begin(), all.end(), is_it)) return {};
  return {{"id", "is new, and there are " + std::to_string(all.size()) + " already; at most " +
                     std::to_string(kMostSources) + " at a time"}};
}

}  // namespace

Inputs::Inputs(ros::NodeHandle node, Frames& frames)
    : frames_(frames), winds_(kMailboxCapacity), drags_(kMailboxCapacity) {
  const boost::function<void(const WindSource::ConstPtr&)> on_wind = [this](const WindSource::ConstPtr& message) {
    winds_.post(withoutBulk(message));
  };
  const boost::function<void(const DragForce::ConstPtr&)> on_drag = [this](const DragForce::ConstPtr& message) {
    drags_.post(withoutBulk(message));
  };
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  wind_subscriber_ = node.subscribe<WindSource>(kWindTopic, kQueueSize, on_wind, ros::VoidConstPtr(), hints);
  drag_subscriber_ = node.subscribe<DragForce>(kDragTopic, kQueueSize, on_drag, ros::VoidConstPtr(), hints);
}

void Inputs::apply(curtain::Simulator& simulator) {
  winds_.collect(waiting_winds_);
  drags_.collect(waiting_drags_);
  work(waiting_winds_, simulator);
  work(waiting_drags_, simulator);
  warnOfOverflow();
  for (const std::string& id : idsOver(simulator.winds(), simulator.time())) simulator.removeWind(id);
  for (const std::string& id : idsOver(simulator.drags(), simulator.time())) simulator.removeDrag(id);
}

template <typename Message>
void Inputs::work(std::deque<boost::shared_ptr<const Message>>& waiting, curtain::Simulator& simulator) {
  while (!waiting.empty()) {
    const std::uint32_t dropped = invalid_ + untransformed_;
    if (!handle(*waiting.front(), simulator)) return;
    if (invalid_ + untransformed_ == dropped) ++taken_;
    waiting.pop_front();
  }
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
    if (problems.empty()) problems = checkRoom(simulator.winds(), message.id);
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
    if (problems.empty()) problems = checkRoom(simulator.drags(), message.id);
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
  last_drop_ = std::string(topic) + ", id '" + forLog(id) + "': header.frame_id: '" + forLog(frame) +
               "' is not known in '" + frames_.world() + "': " + forLog(lookup.error, kLongestName);
  ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "dropped a message on " << last_drop_);
  return false;
}

void Inputs::drop(const char* topic, const std::string& id, const std::vector<curtain::Problem>& problems) {
  ++invalid_;
  last_drop_ = std::string(topic) + ", id '" + forLog(id) + "': " + curtain::describe(problems);
  ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "dropped a message on " << last_drop_);
}

void Inputs::warnOfOverflow() {
  const std::uint64_t lost = overflowed();
  if (lost == warned_overflow_) return;
  ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "messages on " << kWindTopic << " or " << kDragTopic << " come faster than "
                                                       << kMailboxCapacity << " a frame: " << lost
                                                       << " of them, the oldest of each frame, dropped so far");
  warned_overflow_ = lost;
}

}  // namespace curtain_ros
