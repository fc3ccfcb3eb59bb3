// SPDX-License-Identifier: BSD-3-Clause
//
// Judges every frame of a curtain node from what it publishes: does the cloth cross itself, does it go through an
// obstacle? Both by brute force, with the obstacles where ~contacts says they were. Answers on ~verdict
// (std_srvs/Trigger) when it is through with all that came: success = nothing crosses, no frame is missing.
//   curtain_judge_frames NODE
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <condition_variable>
#include <deque>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <sstream>
#include <thread>

#include "cloth/cloth.h"
#include "contact/oracle/piercings.h"
#include "curtain_sim/Contacts.h"
#include "curtain_sim/CurtainState.h"
#include "obstacles/obstacle_set.h"
#include "ros/parameters/parameters.h"
#include "simulator/self_crossings.h"

namespace curtain_ros {
namespace {

using curtain::Vec3;

// Numbers in ~state are rounded to 6e-8 of their size, below 4 m here.
constexpr double kDepthTolerance = 1e-6;  // [m]

struct Frame {
  curtain_sim::CurtainStateConstPtr state;
  curtain_sim::ContactsConstPtr contacts;
};

// Pairs of messages with the same stamp, in the order in which they are complete.
class Inbox {
 public:
  void take(const curtain_sim::CurtainStateConstPtr& state) {
    add(state->header.stamp, [&](Frame& frame) { frame.state = state; });
  }
  void take(const curtain_sim::ContactsConstPtr& contacts) {
    add(contacts->header.stamp, [&](Frame& frame) { frame.contacts = contacts; });
  }

  // Waits; none: stopped.
  std::optional<Frame> next() {
    std::unique_lock<std::mutex> lock(mutex_);
    change_.wait(lock, [this] { return !complete_.empty() || stopped_; });
    if (complete_.empty()) return std::nullopt;
    Frame frame = complete_.front();
    complete_.pop_front();
    return frame;
  }
  void judged() {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++judged_;
    change_.notify_all();
  }
  // All that came before this call.
  void waitUntilJudged() {
    std::unique_lock<std::mutex> lock(mutex_);
    const std::uint64_t asked = came_;
    change_.wait(lock, [&] { return judged_ >= asked || stopped_; });
  }
  void stop() {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = true;
    change_.notify_all();
  }

 private:
  template <typename Put>
  void add(const ros::Time& stamp, const Put& put) {
    const std::lock_guard<std::mutex> lock(mutex_);
    Frame& frame = waiting_[stamp];
    put(frame);
    if (!frame.state || !frame.contacts) return;
    complete_.push_back(frame);
    waiting_.erase(waiting_.begin(), std::next(waiting_.find(stamp)));
    ++came_;
    change_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable change_;
  std::map<ros::Time, Frame> waiting_;
  std::deque<Frame> complete_;
  std::uint64_t came_ = 0, judged_ = 0;
  bool stopped_ = false;
};

class Judge {
 public:
  explicit Judge(const curtain::Scene& scene)
      : grid_(curtain::makeGrid(scene.cloth)), obstacles_(scene, curtain::shapesBy(curtain::resolveMeshUrl)) {
    for (std::size_t i = 0; i < scene.obstacles.size(); ++i) numbers_[scene.obstacles[i].name] = static_cast<int>(i);
    position_.assign(grid_.size(), 0.0);
  }

  void judge(const Frame& frame) {
    if (!state_ || frame.state->positions != state_->positions) {
      readPositions(*frame.state);
      crossings_ = curtain::countSelfCrossings(grid_, position_);
    }
    state_ = frame.state;
    ++frames_;
    const std::uint64_t number = frame.state->statistics.frame;
    if (last_ > 0) missing_ += number - last_ - 1;
    last_ = number;
    note(number, "itself", crossings_);
    for (const curtain_sim::ObstacleContact& contact : frame.contacts->obstacles) {
      const curtain::Piercings found = curtain::countPiercings(obstacles_.shape(numbers_.at(contact.name)),
                                                               placeOf(contact), grid_, position_, kDepthTolerance);
      note(number, contact.name, found.nodes + found.edges + found.faces);
      max_obstacles_ = std::max(max_obstacles_, frame.contacts->obstacles.size());
    }
  }

  bool clean() const { return frames_ > 0 && missing_ == 0 && found_.empty(); }
  std::string report() const {
    std::ostringstream text;
    text << frames_ << " frames, " << missing_ << " missing, " << max_obstacles_ << " obstacles";
    for (const auto& [name, what] : found_)
      text << "; goes through " << name << " in " << what.frames << " frames, first " << what.first << ", at most "
           << what.most << " parts";
    return text.str();
  }

 private:
  struct Found {
    std::uint64_t frames = 0, first = 0;
    std::int64_t most = 0;
  };

  void readPositions(const curtain_sim::CurtainState& state) {
    for (int i = 0; i < grid_.rows; ++i) {
      for (int j = 0; j < grid_.columns; ++j) {
        const std::size_t at = 3 * static_cast<std::size_t>(i * grid_.columns + j);
        position_.set(grid_.index(i, j), Vec3(state.positions[at], state.positions[at + 1], state.positions[at + 2]));
      }
    }
  }

  static curtain::Transform placeOf(const curtain_sim::ObstacleContact& contact) {
    curtain::Pose pose;
    pose.position = Vec3(contact.origin.x, contact.origin.y, contact.origin.z);
    pose.orientation =
        curtain::Rotation(contact.orientation.w, contact.orientation.x, contact.orientation.y, contact.orientation.z);
    return curtain::Transform(pose);
  }

  void note(std::uint64_t frame, const std::string& what, std::int64_t count) {
    if (count == 0) return;
    Found& found = found_[what];
    if (found.frames++ == 0) found.first = frame;
    found.most = std::max(found.most, count);
  }

  curtain::Grid grid_;
  curtain::ObstacleSet obstacles_;
  std::map<std::string, int> numbers_;
  curtain::Field3 position_;
  curtain_sim::CurtainStateConstPtr state_;  // that position_ and crossings_ are of
  std::int64_t crossings_ = 0;
  std::uint64_t frames_ = 0, missing_ = 0, last_ = 0;
  std::size_t max_obstacles_ = 0;
  std::map<std::string, Found> found_;
};

int run(const std::string& node_name) {
  ros::NodeHandle curtain(node_name), own("~");
  while (ros::ok() && !curtain.hasParam("scene")) ros::WallDuration(0.02).sleep();
  Judge judge(readParameters(curtain).scene);
  Inbox inbox;
  ros::Subscriber states = curtain.subscribe<curtain_sim::CurtainState>(
      "state", 0,
      boost::function<void(const curtain_sim::CurtainStateConstPtr&)>([&](const auto& m) { inbox.take(m); }));
  ros::Subscriber contacts = curtain.subscribe<curtain_sim::Contacts>(
      "contacts", 0,
      boost::function<void(const curtain_sim::ContactsConstPtr&)>([&](const auto& m) { inbox.take(m); }));
  std::mutex mutex;
  std::thread worker([&] {
    while (const std::optional<Frame> frame = inbox.next()) {
      {
        const std::lock_guard<std::mutex> lock(mutex);
        judge.judge(*frame);
      }
      inbox.judged();
    }
  });
  const auto answer = [&](std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
    inbox.waitUntilJudged();
    const std::lock_guard<std::mutex> lock(mutex);
    response.success = judge.clean();
    response.message = judge.report();
    return true;
  };
  ros::ServiceServer verdict = own.advertiseService<std_srvs::Trigger::Request, std_srvs::Trigger::Response>(
      "verdict", boost::function<bool(std_srvs::Trigger::Request&, std_srvs::Trigger::Response&)>(answer));
  ros::MultiThreadedSpinner(2).spin();
  inbox.stop();
  worker.join();
  return 0;
}

}  // namespace
}  // namespace curtain_ros

int main(int argc, char** argv) {
  ros::init(argc, argv, "curtain_judge_frames");
  if (argc != 2) {
    std::cerr << "usage: curtain_judge_frames NODE\n";
    return 2;
  }
  return curtain_ros::run(argv[1]);
}
