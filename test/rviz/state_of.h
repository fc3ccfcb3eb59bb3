// SPDX-License-Identifier: BSD-3-Clause
//
// ~state and ~loads as the node sends them.
#pragma once

#include <utility>
#include <vector>

#include "curtain_sim/simulator.h"
#include "ros/outputs/state_messages.h"

namespace curtain_test {

inline curtain_sim::CurtainState stateOf(const curtain::Simulator& simulator, bool folds = false) {
  curtain_ros::NodeParams params;
  params.state_folds = folds;
  curtain_ros::GeometryCache geometry(simulator);
  return *curtain_ros::StateMessages(params, geometry).build(ros::Time(1.0), {});
}

inline curtain_sim::Loads loadsOf(const curtain::Simulator& simulator) {
  return *curtain_ros::LoadMessages(curtain_ros::NodeParams(), simulator).build(ros::Time(1.0));
}

/// 8 x 7 nodes, gathered, in a wind, after half a second.
inline curtain::Simulator blownCloth(bool closed, int frames = 30, std::vector<curtain::SlitParams> slits = {}) {
  curtain::Scene scene;
  scene.cloth.rows = 8;
  scene.cloth.columns = 7;
  scene.cloth.folds = 4;
  scene.cloth.closed = closed;
  scene.cloth.slits = std::move(slits);
  scene.cloth.height = 1.0;
  scene.hang.from = {0.0, 0.0, 2.0};
  scene.hang.to = {0.6, 0.0, 2.0};
  if (closed) scene.hang.radius = 0.1;
  curtain::WindParams wind;
  wind.id = "fan";
  wind.position = {0.3, -1.0, 1.5};
  wind.direction = {0.0, 1.0, 0.2};
  wind.radius = 0.5;
  wind.half_angle = 0.3;
  wind.pressure = 4.0;
  scene.wind.push_back(wind);
  curtain::Simulator simulator(scene);
  for (int frame = 0; frame < frames; ++frame) simulator.step();
  return simulator;
}

}  // namespace curtain_test
