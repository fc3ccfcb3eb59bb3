// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 6: the node program. It ends cleanly on SIGINT and on SIGTERM, which init systems, containers and batch
// schedulers send; the curtain is stopped, and its snapshot written, before ROS is: roscpp unregisters from the master,
// and would wait for ever for one that hangs.
#include "ros/curtain_node.h"

#include <ros/callback_queue.h>
#include <ros/console.h>
#include <ros/init.h>
#include <unistd.h>

#include <csignal>

namespace {

volatile std::sig_atomic_t runs = 0;
volatile std::sig_atomic_t told_to_end = 0;

constexpr unsigned kUnregister = 3;  // [s] for unregistering from the master; a few milliseconds when it answers

void handleSignals() {
  const auto end = [](int) {
    told_to_end = 1;
    if (runs != 0) return;
    ros::requestShutdown();  // it may be waiting for the master, to come up or to answer
    alarm(kUnregister);
  };
  for (const int number : {SIGINT, SIGTERM}) std::signal(number, end);
  std::signal(SIGALRM, [](int) { _exit(0); });
  // A file that reaches a limit of its size is a failed write, not the end of the node.
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "curtain_node", ros::init_options::NoSigintHandler);
  handleSignals();
  const ros::NodeHandle node;
  const ros::NodeHandle private_node("~");
  try {
    curtain_ros::CurtainNode curtain(node, private_node);
    runs = 1;
    alarm(0);  // told to end meanwhile: it does so in order
    while (ros::ok() && told_to_end == 0) ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.1));
    curtain.stop();
    alarm(kUnregister);
  } catch (const curtain_ros::ParameterError& e) {
    ROS_FATAL_STREAM(e.what());
    return 1;
  }
  ros::shutdown();
  return 0;
}
