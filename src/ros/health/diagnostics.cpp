// SPDX-License-Identifier: BSD-3-Clause
#include "ros/health/diagnostics.h"

namespace curtain_ros {

Diagnostics::Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, double period,
                         bool clock_simulated, HealthDesk& desk, const MasterWatch& master)
    : desk_(desk), updater_(node, private_node, private_node.getNamespace()) {
  updater_.setHardwareID("none");
  updater_.add("simulation", [this, clock_simulated](Status& status) {
    const Health none;
    const ros::Time clock = ros::Time::now();
    checkSimulation(health_ ? *health_ : none,
                    {ros::SteadyTime::now(), desk_.lastFrame(), clock_simulated, clock == clock_at_last_look_}, rises_,
                    status);
    clock_at_last_look_ = clock;
  });
  addCheck("inputs", checkInputs);
  addCheck("obstacles", checkObstacles);
  addCheck("snapshots", checkSnapshots);
  updater_.add("master", [this, &master](Status& status) {
    checkMaster(master.answers(), master.lost(), ros::SteadyTime::now(), rises_, status);
  });
  thread_ = std::make_unique<Periodic>(period, [this] { publish(); });
}

void Diagnostics::addCheck(const std::string& name, Check check) {
  updater_.add(name, [this, check](Status& status) {
    const Health none;
    check(health_ ? *health_ : none, ros::SteadyTime::now(), rises_, status);
  });
}

void Diagnostics::publish() {
  health_ = desk_.ask();
  updater_.force_update();
}

}  // namespace curtain_ros
