// SPDX-License-Identifier: BSD-3-Clause
//
// Opening a curtain on a rail: topic ~open and action ~open_curtain. Callbacks only leave what came in a mailbox; the
// simulation thread works it off at the start of a frame, and tells the client how far it is after it.
#pragma once

#include <actionlib/server/action_server.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <std_msgs/Float64.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/OpenCurtainAction.h"
#include "curtain_sim/simulator.h"
#include "ros/inputs/inputs.h"
#include "ros/inputs/mailbox.h"

namespace curtain_ros {

/// What is wrong with a goal; empty: nothing.
std::vector<curtain::Problem> checkGoal(const curtain_sim::OpenCurtainGoal& goal);

/// Its speed and force, those of the scene where it leaves them open.
curtain::DriveParams driveOf(const curtain_sim::OpenCurtainGoal& goal, const curtain::DriveParams& scene);

/// Tells when a drive no longer gets anywhere.
class StandstillWatch {
 public:
  /// time [s], simulated; off: by how much the opening is still off its goal, >= 0. True: it has not come nearer for a
  /// while.
  bool standsStill(double time, double off) noexcept;

 private:
  double since_ = 0.0, nearest_ = 0.0;
  bool begun_ = false;
};

class OpenCurtain {
 public:
  /// For a cloth that hangs from a rail (Simulator::layers()). Subscribes ~open and serves ~open_curtain, of a layer
  /// below ~layers/NAME. inputs must outlive this.
  OpenCurtain(const ros::NodeHandle& private_node, Inputs& inputs, const std::string& layer);

  /// Topics that it subscribes.
  std::string topic() const { return subscriber_.getTopic(); }

  /// Before a frame: applies what arrived, in order. Simulation thread.
  void apply(curtain::Simulator& simulator);
  /// After a frame: feedback and result. Simulation thread.
  void update(curtain::Simulator& simulator);
  /// The simulation begins again from the scene: nothing is drawn any more. Simulation thread.
  void restart();

 private:
  using Server = actionlib::ActionServer<curtain_sim::OpenCurtainAction>;
  using Goal = Server::GoalHandle;
  // Exactly one of the two.
  struct Letter {
    std_msgs::Float64::ConstPtr opening;
    std::optional<Goal> goal;
    bool cancels = false;
  };

  void read(const Letter& letter, curtain::Simulator& simulator);
  void accept(Goal goal, curtain::Simulator& simulator);
  void cancel(const Goal& goal, curtain::Simulator& simulator);
  void supersede(const std::string& why);
  const curtain::DriveParams& sceneDrive(const curtain::Simulator& simulator) const;

  Inputs& inputs_;
  const std::string layer_, space_;  // its name, and what topics begin with
  ros::NodeHandle node_;             // of its topics
  Mailbox<Letter> mailbox_;
  std::deque<Letter> letters_;  // scratch
  std::optional<Goal> goal_;    // that is being worked on
  StandstillWatch watch_;
  double opening_ = 0.0;  // at the last frame's end
  ros::Subscriber subscriber_;
  Server server_;
};

}  // namespace curtain_ros
