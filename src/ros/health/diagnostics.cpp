// SPDX-License-Identifier: BSD-3-Clause
#include "ros/health/diagnostics.h"

namespace curtain_ros {

Diagnostics::Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node, double period,
                         bool clock_simulated)
    : updater_(node, private_node, private_node.getNamespace()) {
  pulse_.clock_simulated = clock_simulated;
  updater_.setHardwareID("none");
  add("simulation", checkSimulation);
  add("inputs", checkInputs);
  add("obstacles", checkObstacles);
  add("snapshots", checkSnapshots);
  add("master", checkMaster);
  thread_ = std::make_unique<Periodic>(period, [this] { publish(); });
}

void Diagnostics::add(const std::string& name, Check* check) {
  updater_.add(name, [this, check](diagnostic_updater::DiagnosticStatusWrapper& status) {
    check(health_, pulse_, rises_, status);
  });
}

void Diagnostics::publish() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    health_ = answer_;
  }
  wanted_.store(true, std::memory_order_relaxed);  // for the next time
  const ros::Time clock = ros::Time::now();
  pulse_.clock_stands = clock == last_clock_;
  last_clock_ = clock;
  pulse_.now = ros::SteadyTime::now();
  pulse_.last_frame.fromNSec(static_cast<std::uint64_t>(last_frame_.load(std::memory_order_relaxed)));
  updater_.force_update();
}

}  // namespace curtain_ros
