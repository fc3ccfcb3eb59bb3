// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 6: the node program.
#include "ros/curtain_node.h"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/spinner.h>

#include <csignal>

int main(int argc, char** argv) {
  ros::init(argc, argv, "curtain_node");
  // roscpp ends cleanly on SIGINT alone; init systems, containers and batch schedulers send SIGTERM.
  std::signal(SIGTERM, [](int) { ros::requestShutdown(); });
  // A file that reaches a limit of its size is a failed write, not the end of the node.
  std::signal(SIGXFSZ, SIG_IGN);
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
