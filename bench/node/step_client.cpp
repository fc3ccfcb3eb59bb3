// SPDX-License-Identifier: BSD-3-Clause
//
// A client of ~step for bench/node/step_rate: prints how many frames a second it gets; or, with "listen" for the
// frames, one that listens to ~state until it is told to end.
#include <ros/ros.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>

#include "curtain_sim/CurtainState.h"
#include "curtain_sim/Step.h"

namespace {

// Frames a second, over so many of them in batches; negative: the node refused.
double measure(const std::string& node, std::uint32_t batch, std::uint32_t frames) {
  ros::NodeHandle handle;
  ros::ServiceClient client = handle.serviceClient<curtain_sim::Step>(node + "/step", true);
  client.waitForExistence();
  curtain_sim::Step step;
  step.request.frames = batch;
  const ros::SteadyTime begin = ros::SteadyTime::now();
  for (std::uint32_t made = 0; made < frames; made += batch) {
    if (!client.call(step) || !step.response.success) return -1.0;
  }
  return frames / (ros::SteadyTime::now() - begin).toSec();
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "step_client", ros::init_options::AnonymousName);
  if (argc != 4) {
    std::cerr << "usage: curtain_step_client NODE BATCH FRAMES|listen\n";
    return 2;
  }
  const std::string node = argv[1], frames = argv[3];
  if (frames == "listen") {
    ros::NodeHandle handle;
    const boost::function<void(const curtain_sim::CurtainState::ConstPtr&)> ignore =
        [](const curtain_sim::CurtainState::ConstPtr&) {};
    const ros::Subscriber subscriber = handle.subscribe<curtain_sim::CurtainState>(node + "/state", 10, ignore);
    ros::spin();
    return EXIT_SUCCESS;
  }
  const double rate = measure(node, static_cast<std::uint32_t>(std::atoi(argv[2])),
                              static_cast<std::uint32_t>(std::atoi(frames.c_str())));
  std::cout << rate << '\n';
  return rate > 0.0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
