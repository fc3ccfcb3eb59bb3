// SPDX-License-Identifier: BSD-3-Clause
//
// Hands that hold the cloth: action ~grasp. Callbacks only leave goals and cancels in a mailbox; the simulation thread
// works them off before the next frame, moves every hand with its tf2 frame, and tells the clients after the frame how
// their grasps go.
//
//   frame fresh             the hand moves there during the step
//   late                    it holds where it was
//   older than the timeout  it lets go, and the goal is aborted
//   not known at first      the goal waits while the listener is young (one second); then it is rejected
#pragma once

#include <actionlib/server/action_server.h>
#include <ros/node_handle.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/GraspAction.h"
#include "curtain_sim/simulator.h"
#include "ros/frames/followed_frame.h"
#include "ros/inputs/inputs.h"
#include "ros/inputs/mailbox.h"

namespace curtain_ros {

class Hands {
 public:
  /// Serves ~grasp. timeout: ~grasp_timeout [s], > 0; frames and inputs must outlive this.
  Hands(ros::NodeHandle private_node, double timeout, Frames& frames, Inputs& inputs);

  /// Before a frame: goals and cancels that came, in order; hands move with their frames. now: of the node's clock.
  /// Simulation thread, as all that follows.
  void apply(curtain::Simulator& simulator, const ros::Time& now);
  /// After a frame: feedback, and what has ended.
  void update(curtain::Simulator& simulator);
  /// The simulation begins again from the scene, or goes on from a snapshot, whose grasps have no client: every hand
  /// lets go, every goal ends with RESET.
  void restart(curtain::Simulator& simulator, const std::string& why);

 private:
  using Server = actionlib::ActionServer<curtain_sim::GraspAction>;
  using Goal = Server::GoalHandle;
  using Result = curtain_sim::GraspResult;
  struct Letter {
    Goal goal;
    bool cancels = false;
  };
  /// A goal that holds, or waits for its frame.
  struct Hand {
    Goal goal;
    std::string id;
    FollowedFrame frame;
    bool holds = false;
    double ends = 0.0;  // [s] of simulated time
  };

  void read(Letter& letter, curtain::Simulator& simulator, const ros::Time& now);
  void cancel(const Goal& goal, curtain::Simulator& simulator);
  bool grip(Hand& hand, curtain::Simulator& simulator, const ros::Time& now);
  bool follow(Hand& hand, curtain::Simulator& simulator, const ros::Time& now);
  bool tell(Hand& hand, curtain::Simulator& simulator);
  void warnOfScene(const curtain::Simulator& simulator);
  void refuse(Goal& goal, const std::vector<curtain::Problem>& problems);
  void end(Hand& hand, curtain::Simulator& simulator, std::uint8_t how, const std::string& message);

  Frames& frames_;
  Inputs& inputs_;
  double timeout_;
  Mailbox<Letter> mailbox_;
  std::deque<Letter> letters_;           // scratch
  std::vector<Hand> hands_;              // in the order of their goals
  std::vector<curtain::GraspEnd> ends_;  // of the scene's hands, as last seen
  Server server_;
};

}  // namespace curtain_ros
