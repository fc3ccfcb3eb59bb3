// SPDX-License-Identifier: BSD-3-Clause
//
// dynamic_reconfigure on the node's own namespace. Its thread leaves the values that somebody sets as a job for the
// simulation thread and waits for what holds then; that is what dynamic_reconfigure publishes. It also writes all
// values to the parameter server, under their names in cfg/Curtain.cfg; ~scene is not touched, and holds at the next
// start. Service ~set_material sets several of them at once.
#pragma once

#include <dynamic_reconfigure/server.h>
#include <ros/node_handle.h>

#include <boost/thread/recursive_mutex.hpp>
#include <functional>
#include <string>
#include <vector>

#include "curtain_sim/CurtainConfig.h"
#include "curtain_sim/SetMaterial.h"
#include "curtain_sim/scene.h"
#include "ros/services/calls.h"
#include "ros/services/service_threads.h"

namespace curtain_ros {

class Tuning {
 public:
  struct Actions {
    std::function<void(const curtain_sim::CurtainConfig&)> apply;  ///< sets what is right of these values
    std::function<curtain_sim::CurtainConfig()> present;           ///< the values that hold
    /// Makes the cloth one of this fabric, or says why not.
    std::function<std::vector<curtain::Problem>(const curtain_sim::SetMaterialRequest&)> set_material;
  };
  /// actions are called by the simulation thread, through calls, and `present` once by the constructor. calls must
  /// outlive this.
  Tuning(const ros::NodeHandle& private_node, Calls& calls, Actions actions);

  ~Tuning() { thread_.stop(); }

  /// Has the values that hold published, when others than this have changed them. Does not wait for that: the parameter
  /// server may not answer. Any thread.
  void refresh() {
    thread_.post([this] { publish(); });
  }

 private:
  using Config = curtain_sim::CurtainConfig;

  void onChange(Config& config);
  bool setMaterial(curtain_sim::SetMaterial::Request& request, curtain_sim::SetMaterial::Response& response);
  void publish();

  Calls& calls_;
  Actions actions_;
  boost::recursive_mutex mutex_;  // never taken by the simulation thread
  ServiceThreads thread_;
  dynamic_reconfigure::Server<Config> server_;
  ros::ServiceServer set_material_;
};

}  // namespace curtain_ros
