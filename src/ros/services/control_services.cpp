// SPDX-License-Identifier: BSD-3-Clause
#include "ros/services/control_services.h"

#include <utility>

namespace curtain_ros {
namespace {

constexpr std::uint32_t kMaxSteppers = 4;  // callers of ~step at a time; others wait for one of these to be answered

}  // namespace

const char kStops[] = "the node stops";

ControlServices::ControlServices(const ros::NodeHandle& private_node, Calls& calls, Actions actions)
    : calls_(calls), actions_(std::move(actions)), short_(private_node, 1), long_(private_node, kMaxSteppers) {
  reset_ = short_.node().advertiseService("reset", &ControlServices::reset, this);
  pause_ = short_.node().advertiseService("pause", &ControlServices::pause, this);
  step_ = long_.node().advertiseService("step", &ControlServices::step, this);
  short_.start();
  long_.start();
}

bool ControlServices::reset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  response.success = calls_.run(actions_.reset);
  if (!response.success) response.message = kStops;
  return true;
}

bool ControlServices::pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  response.success = calls_.run([&] { actions_.set_paused(request.data != 0); });
  response.message = !response.success ? kStops : request.data != 0 ? "paused" : "running";
  return true;
}

bool ControlServices::step(curtain_sim::Step::Request& request, curtain_sim::Step::Response& response) {
  response.message = actions_.no_step;
  if (!response.message.empty()) return true;
  std::future<LockStep::Answer> answer;
  if (calls_.run([&] { answer = actions_.lock_step->ask(request.frames); }))
    response = answer.get();
  else
    response.message = kStops;
  return true;
}

}  // namespace curtain_ros
