// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 6: the node as a nodelet.
#include <nodelet/nodelet.h>
#include <ros/console.h>

#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "ros/curtain_node.h"

namespace curtain_ros {

class CurtainNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      curtain_ = std::make_unique<CurtainNode>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const ParameterError& e) {
      NODELET_FATAL_STREAM(e.what());
      throw;  // the manager answers that loading failed
    }
  }

  std::unique_ptr<CurtainNode> curtain_;
};

}  // namespace curtain_ros

PLUGINLIB_EXPORT_CLASS(curtain_ros::CurtainNodelet, nodelet::Nodelet)
