// SPDX-License-Identifier: BSD-3-Clause
#include "ros/hands/hands.h"

#include <ros/console.h>

#include <algorithm>
#include <limits>

#include "ros/frames/geometry.h"
#include "ros/hands/read_goal.h"
#include "ros/inputs/mailbox.h"
#include "ros/inputs/read_messages.h"
#include "scene/ranges.h"

namespace curtain_ros {

using curtain::Simulator;
using curtain_sim::GraspFeedback;
using curtain_sim::GraspResult;

namespace {

std::string numberOf(std::size_t nodes) { return std::to_string(nodes) + (nodes == 1 ? " node" : " nodes"); }

// Length of a frame of the simulation [s].
double stepOf(const Simulator& simulator) { return 1.0 / simulator.scene().solver.frame_rate; }

}  // namespace

Hands::Hands(ros::NodeHandle private_node, double timeout, Frames& frames, Inputs& inputs)
    : frames_(frames),
      inputs_(inputs),
      timeout_(timeout),
      mailbox_(kMailboxCapacity),
      server_(
          private_node, "grasp",
          [this](Goal goal) {
            mailbox_.post({goal, false});
          },
          [this](Goal goal) {
            mailbox_.post({goal, true});
          },
          false) {
  server_.start();
}

void Hands::apply(Simulator& simulator, const ros::Time& now) {
  const auto forget = [this](const auto& ended) {
    hands_.erase(std::remove_if(hands_.begin(), hands_.end(), ended), hands_.end());
  };
  mailbox_.collect(letters_);
  for (Letter& letter : letters_) read(letter, simulator, now);
  letters_.clear();
  forget([&](Hand& hand) { return hand.holds ? !follow(hand, simulator, now) : !grip(hand, simulator, now); });
}

void Hands::read(Letter& letter, Simulator& simulator, const ros::Time&) {
  if (letter.cancels) return cancel(letter.goal, simulator);
  const curtain_sim::GraspGoal& wanted = *letter.goal.getGoal();
  curtain::GraspParams grasp;
  const std::string id = letter.goal.getGoalID().id;
  const std::vector<curtain::Problem> problems = toGrasp(wanted, id, wholeCloth(simulator.scene()), grasp);
  if (!problems.empty()) return refuse(letter.goal, problems);
  hands_.push_back({letter.goal, id, FollowedFrame(wanted.frame, timeout_, "~grasp_timeout"), false, 0.0});
}

// Takes hold, if the frame is known. False: it is refused.
bool Hands::grip(Hand& hand, Simulator& simulator, const ros::Time& now) {
  switch (hand.frame.update(frames_, now, stepOf(simulator))) {
    case FollowedFrame::Standing::kWaiting:
      return true;
    case FollowedFrame::Standing::kLost:
      refuse(hand.goal, {{"frame", "'" + forLog(hand.frame.name()) + "' " + hand.frame.error()}});
      return false;
    case FollowedFrame::Standing::kFresh:
      break;
  }
  const curtain_sim::GraspGoal& wanted = *hand.goal.getGoal();
  curtain::GraspParams grasp;
  toGrasp(wanted, hand.id, wholeCloth(simulator.scene()), grasp);
  grasp.frame = *hand.frame.pose();
  const std::vector<curtain::Problem> problems = simulator.setGrasp(grasp);
  if (!problems.empty()) {
    refuse(hand.goal, problems);
    return false;
  }
  inputs_.countAccepted();
  hand.holds = true;
  hand.ends = wanted.lifetime > 0.0 ? simulator.time() + wanted.lifetime : std::numeric_limits<double>::infinity();
  hand.goal.setAccepted("holds " + numberOf(simulator.graspState(hand.id)->nodes.size()));
  return true;
}

// False: the frame is lost, and the hand has let go.
bool Hands::follow(Hand& hand, Simulator& simulator, const ros::Time& now) {
  if (hand.frame.update(frames_, now, stepOf(simulator)) == FollowedFrame::Standing::kFresh) {
    simulator.moveGrasp(hand.id, *hand.frame.pose());
    return true;
  }
  const std::string why = "frame '" + forLog(hand.frame.name()) + "' " + hand.frame.error();
  ROS_WARN_STREAM("a hand has let go: " << why);
  end(hand, simulator, GraspResult::FRAME_LOST, why);
  return false;
}

void Hands::cancel(const Goal& goal, Simulator& simulator) {
  const auto found = std::find_if(hands_.begin(), hands_.end(), [&](const Hand& hand) { return hand.goal == goal; });
  if (found == hands_.end()) return;
  end(*found, simulator, GraspResult::CANCELLED, "it was cancelled");
  hands_.erase(found);
}

void Hands::update(Simulator& simulator) {
  warnOfScene(simulator);
  hands_.erase(
      std::remove_if(hands_.begin(), hands_.end(), [&](Hand& hand) { return hand.holds && !tell(hand, simulator); }),
      hands_.end());
}

// False: it has ended.
bool Hands::tell(Hand& hand, Simulator& simulator) {
  const std::optional<curtain::GraspState> found = simulator.graspState(hand.id);
  if (!found) {
    end(hand, simulator, GraspResult::RESET, "the curtain holds another state");
    return false;
  }
  const curtain::GraspState& state = *found;
  const curtain::Rotation to_frame = hand.frame.pose()->orientation.conjugate();
  GraspFeedback feedback;
  feedback.nodes = static_cast<std::uint32_t>(state.nodes.size());
  feedback.pull.header.frame_id = frames_.isWorld(hand.frame.name()) ? frames_.world() : hand.frame.name();
  feedback.pull.header.stamp = ros::Time::now();
  feedback.pull.wrench.force = toVector(to_frame * state.force);
  feedback.pull.wrench.torque = toVector(to_frame * state.torque);
  feedback.slipped = state.slipped;
  feedback.late = hand.frame.late();
  hand.goal.publishFeedback(feedback);
  if (state.end == curtain::GraspEnd::kBroken) {
    end(hand, simulator, GraspResult::BROKEN,
        "it was torn out: the pull of " + curtain::formatNumber(state.force.norm()) + " N reached break_force");
  } else if (state.end == curtain::GraspEnd::kSlippedOut) {
    end(hand, simulator, GraspResult::SLIPPED_OUT, "nothing is left between the pads");
  } else if (simulator.time() >= hand.ends) {
    end(hand, simulator, GraspResult::RELEASED, "its lifetime is over");
  } else {
    return true;
  }
  return false;
}

void Hands::restart(Simulator& simulator, const std::string& why) {
  for (Hand& hand : hands_) end(hand, simulator, GraspResult::RESET, why);
  hands_.clear();
  const auto ofScene = [&](const std::string& id) {
    const auto& all = simulator.scene().hands;
    return std::any_of(all.begin(), all.end(), [&](const curtain::HandParams& hand) { return hand.grasp.id == id; });
  };
  for (const std::string& id : simulator.grasps()) {
    if (!ofScene(id)) simulator.releaseGrasp(id);
  }
}

// Once for each that failed.
void Hands::warnOfScene(const Simulator& simulator) {
  const std::vector<curtain::HandParams>& all = simulator.scene().hands;
  ends_.resize(all.size(), curtain::GraspEnd::kWaiting);
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto state = simulator.graspState(all[k].grasp.id);
    const curtain::GraspEnd end = state ? state->end : curtain::GraspEnd::kReleased;
    const std::string failure = end == ends_[k] ? "" : curtain::describeFailure(all[k], end);
    ends_[k] = end;
    if (!failure.empty()) ROS_WARN_STREAM(forLog(failure));
  }
}

void Hands::refuse(Goal& goal, const std::vector<curtain::Problem>& problems) {
  inputs_.refuse("~grasp/goal", problems);
  Result result;
  result.end = Result::REFUSED;
  result.message = curtain::describe(problems);
  goal.setRejected(result, result.message);
}

// Lets go, and ends the goal.
void Hands::end(Hand& hand, Simulator& simulator, std::uint8_t how, const std::string& message) {
  Result result;
  result.end = how;
  result.message = message;
  if (const auto state = simulator.graspState(hand.id)) result.slipped = state->slipped;
  simulator.releaseGrasp(hand.id);
  if (how == Result::RELEASED)
    hand.goal.setSucceeded(result, message);
  else if (how == Result::CANCELLED)
    hand.goal.setCanceled(result, message);
  else if (hand.holds)
    hand.goal.setAborted(result, message);
  else
    hand.goal.setRejected(result, message);  // it still waits for its frame
}

}  // namespace curtain_ros
