// SPDX-License-Identifier: BSD-3-Clause
#include "ros/inputs/inputs.h"

#include <ros/console.h>

#include "ros/inputs/mailbox.h"
#include "ros/inputs/read_messages.h"
#include "ros/time/warn_period.h"
#include "scene/sources.h"

namespace curtain_ros {

using curtain::Simulator;
using curtain_sim::DragForce;
using curtain_sim::WindSource;

namespace {

using Problems = std::vector<curtain::Problem>;

// Messages kept of a topic between two frames. Senders at 1 kHz for a frame of 1/20 s fit.

// Each source costs a pass over the cloth in each substep: far more than anybody places, few enough for a frame.
constexpr std::size_t kMaxSources = 256;

template <typename Params>
Problems checkRoom(const std::vector<Params>& all, const std::string& id) {
  if (all.size() < kMaxSources || curtain::findById(all, id) != nullptr) return {};
  return {{"id", "is new, and there are " + std::to_string(all.size()) + " already; at most " +
                     std::to_string(kMaxSources) + " at a time"}};
}

template <typename Params>
std::vector<std::string> idsOver(const std::vector<Params>& all, double time) {
  std::vector<std::string> ids;
  for (const Params& one : all) {
    if (one.end <= time) ids.push_back(one.id);
  }
  return ids;
}

// What a message does to the simulator, in the words of its type.
Problems add(const WindSource& message, const curtain::Pose& frame, Simulator& simulator) {
  const curtain::WindParams* replaced = curtain::findById(simulator.winds(), message.id);
  curtain::WindParams wind = replaced ? *replaced : curtain::WindParams();
  Problems problems = toWind(message, frame, simulator.time(), wind);
  if (problems.empty()) problems = checkRoom(simulator.winds(), message.id);
  return problems.empty() ? simulator.setWind(wind) : problems;
}
Problems add(const DragForce& message, const curtain::Pose& frame, Simulator& simulator) {
  curtain::DragParams drag;
  Problems problems = toDrag(message, frame, simulator.time(), wholeCloth(simulator.scene()), drag);
  if (problems.empty()) problems = checkRoom(simulator.drags(), message.id);
  return problems.empty() ? simulator.setDrag(drag) : problems;
}
void remove(const WindSource& message, Simulator& simulator) { simulator.removeWind(message.id); }
void remove(const DragForce& message, Simulator& simulator) { simulator.removeDrag(message.id); }
void removeAll(const WindSource&, Simulator& simulator) { simulator.clearWinds(); }
void removeAll(const DragForce&, Simulator& simulator) { simulator.clearDrags(); }

}  // namespace

Inputs::Inputs(ros::NodeHandle node, Frames& frames)
    : frames_(frames),
      winds_{"wind_source", Mailbox<WindSource::ConstPtr>(kMailboxCapacity), {}, {}},
      drags_{"drag_force", Mailbox<DragForce::ConstPtr>(kMailboxCapacity), {}, {}} {
  subscribe(node, winds_);
  subscribe(node, drags_);
}

template <typename Message>
void Inputs::subscribe(ros::NodeHandle& node, Topic<Message>& topic) {
  using Pointer = boost::shared_ptr<const Message>;
  const boost::function<void(const Pointer&)> on_message = [&topic](const Pointer& message) {
    topic.mailbox.post(message);
  };
  topic.subscriber = node.subscribe<Message>(topic.name, kQueueSize, on_message, ros::VoidConstPtr(),
                                             ros::TransportHints().tcpNoDelay());
}

void Inputs::apply(Simulator& simulator) {
  work(winds_, simulator);
  work(drags_, simulator);
  warnOfOverflow();
  for (const std::string& id : idsOver(simulator.winds(), simulator.time())) simulator.removeWind(id);
  for (const std::string& id : idsOver(simulator.drags(), simulator.time())) simulator.removeDrag(id);
  carried_.update(frames_, simulator);
}

template <typename Message>
void Inputs::work(Topic<Message>& topic, Simulator& simulator) {
  topic.mailbox.collect(topic.waiting);
  while (!topic.waiting.empty() && handle(topic.name, *topic.waiting.front(), simulator)) topic.waiting.pop_front();
}

template <typename Message>
bool Inputs::handle(const char* topic, const Message& message, Simulator& simulator) {
  const std::string name = std::string(topic) + ", id '" + forLog(message.id) + "'";
  Problems problems = checkHead(message);
  if (problems.empty()) {
    if (message.action == Message::DELETE) {
      remove(message, simulator);
    } else if (message.action == Message::DELETEALL) {
      removeAll(message, simulator);
    } else {
      const FrameLookup frame = frames_.lookup(message.header.frame_id);
      if (frame.may_come) return false;
      if (!frame.known) {
        ++untransformed_;
        drop(name, "header.frame_id: '" + forLog(message.header.frame_id) + "' is not known in '" + frames_.world() +
                       "': " + forLog(frame.error, kLongestName));
        return true;
      }
      problems = add(message, frame.pose, simulator);
    }
  }
  if (problems.empty()) {
    countAccepted();
    note(message);
  } else {
    refuse(name, problems);
  }
  return true;
}

void Inputs::refuse(const std::string& message, const Problems& problems) {
  ++invalid_;
  drop(message, curtain::describe(problems));
}

void Inputs::drop(const std::string& message, const std::string& why) {
  last_drop_ = message + ": " + why;
  ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "dropped a message on " << last_drop_);
}

void Inputs::count(curtain_sim::Statistics& statistics) const {
  statistics.messages_taken = accepted_;
  statistics.dropped_invalid = invalid_;
  statistics.dropped_untransformed = untransformed_;
  statistics.dropped_overflow = static_cast<std::uint32_t>(winds_.mailbox.lost() + drags_.mailbox.lost());
}

void Inputs::warnOfOverflow() {
  const std::uint64_t lost = winds_.mailbox.lost() + drags_.mailbox.lost();
  if (lost == warned_overflow_) return;
  ROS_WARN_STREAM_THROTTLE(kWarnPeriod, "messages on " << winds_.name << " or " << drags_.name << " come faster than "
                                                       << kMailboxCapacity << " a frame: " << lost
                                                       << " of them, the oldest of each frame, dropped so far");
  warned_overflow_ = lost;
}

}  // namespace curtain_ros
