// SPDX-License-Identifier: BSD-3-Clause
#include "ros/tuning/tuning.h"

#include <utility>

#include "ros/services/control_services.h"

namespace curtain_ros {
namespace {

// The server begins with what is on the parameter server, which may be of an earlier run.
const ros::NodeHandle& withParameters(const ros::NodeHandle& node, const curtain_sim::CurtainConfig& present) {
  present.__toServer__(node);
  return node;
}

}  // namespace

Tuning::Tuning(const ros::NodeHandle& private_node, Calls& calls, Actions actions)
    : calls_(calls),
      actions_(std::move(actions)),
      thread_(private_node, 1),
      server_(mutex_, withParameters(thread_.node(), actions_.present())) {
  // setCallback() calls it once; the values are those that hold.
  server_.setCallback([this, begun = false](Config& config, std::uint32_t) mutable {
    if (begun) onChange(config);
    begun = true;
  });
  set_material_ = thread_.node().advertiseService("set_material", &Tuning::setMaterial, this);
  thread_.start();
}

bool Tuning::setMaterial(curtain_sim::SetMaterial::Request& request, curtain_sim::SetMaterial::Response& response) {
  std::vector<curtain::Problem> problems;
  const bool tried = calls_.run([&] { problems = actions_.set_material(request); });
  response.message = tried ? curtain::describe(problems) : kStops;
  response.success = response.message.empty();
  if (tried) publish();
  return true;
}

void Tuning::onChange(Config& config) {
  calls_.run([&] {
    actions_.apply(config);
    config = actions_.present();
  });
}

void Tuning::publish() {
  const boost::recursive_mutex::scoped_lock lock(mutex_);
  Config config;
  if (calls_.run([&] { config = actions_.present(); })) server_.updateConfig(config);
}

}  // namespace curtain_ros
