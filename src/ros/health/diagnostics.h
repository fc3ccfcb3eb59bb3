// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: /diagnostics, once every ~diagnostic_period by the computer's clock, on a thread of its own; whoever listens
// or not, as aggregators expect.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <memory>
#include <string>

#include "ros/health/health.h"
#include "ros/health/health_checks.h"
#include "ros/time/periodic.h"
#include "ros/watch/master_watch.h"

namespace curtain_ros {

class Diagnostics {
 public:
  /// desk and master must outlive this.
  ///   period           [s], > 0
  ///   clock_simulated  frames follow /clock
  Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, double period, bool clock_simulated,
              HealthDesk& desk, const MasterWatch& master);

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;
  using Check = void (*)(const Health&, const ros::SteadyTime&, Rises&, Status&);

  void publish();
  void addCheck(const std::string& name, Check check);

  HealthDesk& desk_;
  std::shared_ptr<const Health> health_;  // none before the simulation thread has answered for the first time
  Rises rises_;
  ros::Time clock_at_last_look_;
  diagnostic_updater::Updater updater_;
  std::unique_ptr<Periodic> thread_;  // last: it uses the others
};

}  // namespace curtain_ros
