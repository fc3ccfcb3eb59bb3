// SPDX-License-Identifier: BSD-3-Clause
#include "ros/opening/open_curtain.h"

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

OpenCurtain::OpenCurtain(ros::NodeHandle private_node, Inputs& inputs)
    : inputs_(inputs),
      mailbox_(kMailboxCapacity),
      server_(
          private_node, "open_curtain",
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
  subscriber_ = private_node.subscribe<std_msgs::Float64>("open", kQueueSize, on_message, ros::VoidConstPtr(),
                                                          ros::TransportHints().tcpNoDelay());
  server_.start();
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
    inputs_.refuse("~open", problems);
    return;
  }
  supersede("a message on ~open came");
  inputs_.countAccepted();
  simulator.setDrive(simulator.scene().rail.drive);
  simulator.setOpening(goal.opening);
}

void OpenCurtain::accept(Goal goal, Simulator& simulator) {
  const OpenCurtainGoal& wanted = *goal.getGoal();
  std::vector<curtain::Problem> problems = checkGoal(wanted);
  if (problems.empty()) problems = simulator.setDrive(driveOf(wanted, simulator.scene().rail.drive));
  if (!problems.empty()) {
    inputs_.refuse("~open_curtain/goal", problems);
    goal.setRejected(resultOf(simulator.statistics().opening, curtain::describe(problems)),
                     curtain::describe(problems));
    return;
  }
  supersede("another goal came");
  inputs_.countAccepted();
  simulator.setOpening(wanted.opening);
  goal.setAccepted();
  goal_ = goal;
  watch_ = StandstillWatch();
}

void OpenCurtain::cancel(const Goal& goal, Simulator& simulator) {
  if (!goal_ || !(*goal_ == goal)) return;
  simulator.releaseDrive();
  supersede("it was cancelled");
}

// Ends the goal that is being worked on.
void OpenCurtain::supersede(const std::string& why) {
  if (goal_) goal_->setCanceled(resultOf(opening_, why), why);
  goal_.reset();
}

void OpenCurtain::update(Simulator& simulator) {
  opening_ = simulator.statistics().opening;
  if (!goal_) return;
  OpenCurtainFeedback feedback;
  feedback.opening = opening_;
  feedback.force = simulator.statistics().drive_force;
  goal_->publishFeedback(feedback);
  const double off = std::abs(opening_ - goal_->getGoal()->opening);
  if (off <= kReached) {
    goal_->setSucceeded(resultOf(opening_, ""));
    goal_.reset();
  } else if (watch_.standsStill(simulator.time(), off)) {
    const std::string why = "the force does not suffice: no nearer for " + curtain::formatNumber(kPatience) + " s";
    simulator.releaseDrive();
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
