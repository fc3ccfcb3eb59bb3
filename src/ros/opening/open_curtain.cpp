// SPDX-License-Identifier: BSD-3-Clause
#include "ros/opening/open_curtain.h"

#include <algorithm>
#include <cmath>

#include "ros/inputs/mailbox.h"
#include "scene/range_checker.h"

namespace curtain_ros {

using curtain::Simulator;
using curtain_sim::OpenCurtainFeedback;
using curtain_sim::OpenCurtainGoal;
using curtain_sim::OpenCurtainResult;

namespace {

// How near the goal counts as reached: a millimetre of a metre's way.
constexpr double kReached = 1e-3;
// A drive that has not come nearer by kProgress of all the way for so long [s] is stopped by something.
constexpr double kPatience = 5.0;
constexpr double kProgress = 1e-4;

OpenCurtainResult resultOf(double opening, const std::string& message) {
  OpenCurtainResult result;
  result.opening = opening;
  result.message = message;
  return result;
}

}  // namespace

std::vector<curtain::Problem> checkGoal(const OpenCurtainGoal& goal) {
  curtain::ProblemLog log;
  curtain::RangeChecker check("", log);
  check.number("opening", goal.opening, curtain::between(0.0, 1.0));
  check.number("speed", goal.speed, curtain::notNegative());
  check.number("force", goal.force, curtain::notNegative());
  return log.problems();
}

curtain::DriveParams driveOf(const OpenCurtainGoal& goal, const curtain::DriveParams& scene) {
  return {goal.speed > 0.0 ? goal.speed : scene.speed, goal.force > 0.0 ? goal.force : scene.force};
}

bool StandstillWatch::standsStill(double time, double off) noexcept {
  if (!begun_ || off < nearest_ - kProgress) {
    begun_ = true;
    since_ = time;
    nearest_ = off;
  }
  return time - since_ > kPatience;
}

OpenCurtain::OpenCurtain(const ros::NodeHandle& private_node, Inputs& inputs, const std::string& layer)
    : inputs_(inputs),
      layer_(layer),
      space_(layer == curtain::kFirstCloth ? "" : "layers/" + layer + "/"),
      node_(private_node),
      mailbox_(kMailboxCapacity),
      server_(
          node_, space_ + "open_curtain",
          [this](Goal goal) {
            mailbox_.post({nullptr, goal, false});
          },
          [this](Goal goal) {
            mailbox_.post({nullptr, goal, true});
          },
          false) {
  const boost::function<void(const std_msgs::Float64::ConstPtr&)> on_message =
      [this](const std_msgs::Float64::ConstPtr& message) {
        mailbox_.post({message, std::nullopt, false});
      };
  subscriber_ = node_.subscribe<std_msgs::Float64>(space_ + "open", kQueueSize, on_message, ros::VoidConstPtr(),
                                                   ros::TransportHints().tcpNoDelay());
  server_.start();
}

// The scene's, of its own rail.
const curtain::DriveParams& OpenCurtain::sceneDrive(const Simulator& simulator) const {
  const curtain::Scene& scene = simulator.scene();
  const auto found = std::find_if(scene.layers.begin(), scene.layers.end(),
                                  [this](const curtain::LayerParams& one) { return one.name == layer_; });
  return found == scene.layers.end() ? scene.rail.drive : found->rail.drive;
}

void OpenCurtain::apply(Simulator& simulator) {
  mailbox_.collect(letters_);
  for (const Letter& letter : letters_) read(letter, simulator);
  letters_.clear();
}

void OpenCurtain::read(const Letter& letter, Simulator& simulator) {
  if (letter.goal) {
    if (letter.cancels)
      cancel(*letter.goal, simulator);
    else
      accept(*letter.goal, simulator);
    return;
  }
  OpenCurtainGoal goal;
  goal.opening = letter.opening->data;
  const std::vector<curtain::Problem> problems = checkGoal(goal);
  if (!problems.empty()) {
    inputs_.refuse("~" + space_ + "open", problems);
    return;
  }
  supersede("a message on ~" + space_ + "open came");
  inputs_.countAccepted();
  simulator.setDrive(sceneDrive(simulator), layer_);
  simulator.setOpening(goal.opening, layer_);
}

void OpenCurtain::accept(Goal goal, Simulator& simulator) {
  const OpenCurtainGoal& wanted = *goal.getGoal();
  std::vector<curtain::Problem> problems = checkGoal(wanted);
  if (problems.empty()) problems = simulator.setDrive(driveOf(wanted, sceneDrive(simulator)), layer_);
  if (!problems.empty()) {
    inputs_.refuse("~" + space_ + "open_curtain/goal", problems);
    goal.setRejected(resultOf(simulator.opening(layer_), curtain::describe(problems)), curtain::describe(problems));
    return;
  }
  supersede("another goal came");
  inputs_.countAccepted();
  simulator.setOpening(wanted.opening, layer_);
  goal.setAccepted();
  goal_ = goal;
  watch_ = StandstillWatch();
}

void OpenCurtain::cancel(const Goal& goal, Simulator& simulator) {
  if (!goal_ || !(*goal_ == goal)) return;
  simulator.releaseDrive(layer_);
  supersede("it was cancelled");
}

// Ends the goal that is being worked on.
void OpenCurtain::supersede(const std::string& why) {
  if (goal_) goal_->setCanceled(resultOf(opening_, why), why);
  goal_.reset();
}

void OpenCurtain::update(Simulator& simulator) {
  opening_ = simulator.opening(layer_);
  if (!goal_) return;
  OpenCurtainFeedback feedback;
  feedback.opening = opening_;
  feedback.force = simulator.driveForce(layer_);
  goal_->publishFeedback(feedback);
  const double off = std::abs(opening_ - goal_->getGoal()->opening);
  if (off <= kReached) {
    goal_->setSucceeded(resultOf(opening_, ""));
    goal_.reset();
  } else if (watch_.standsStill(simulator.time(), off)) {
    const std::string why = "the force does not suffice: no nearer for " + curtain::formatNumber(kPatience) + " s";
    simulator.releaseDrive(layer_);
    goal_->setAborted(resultOf(opening_, why), why);
    goal_.reset();
  }
}

void OpenCurtain::restart() {
  const std::string why = "the curtain started again";
  if (goal_) goal_->setAborted(resultOf(opening_, why), why);
  goal_.reset();
}

}  // namespace curtain_ros
