// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 6: the node program.
#include "ros/curtain_node.h"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/spinner.h>

int main(int argc, char** argv) {
  ros::init(argc, argv, "curtain_node");
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  try {
    const curtain_ros::CurtainNode curtain(node, private_node);
    ros::spin();
  } catch (const curtain_ros::ParameterError& e) {
    ROS_FATAL_STREAM(e.what());
    return 1;
  }
  return 0;
}
