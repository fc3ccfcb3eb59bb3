// SPDX-License-Identifier: BSD-3-Clause
//
// Hands for tests.
#pragma once

#include <string>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain_test {

inline curtain::GraspParams ballGrasp(const std::string& id, const curtain::Vec3& at, double radius) {
  curtain::GraspParams grasp;
  grasp.id = id;
  grasp.frame.position = at;
  grasp.radius = radius;
  return grasp;
}

inline curtain::GraspParams nodeGrasp(const std::string& id, const std::vector<curtain::NodeIndex>& nodes) {
  curtain::GraspParams grasp;
  grasp.id = id;
  grasp.region = curtain::GraspRegion::kNodes;
  grasp.nodes = nodes;
  return grasp;
}

inline std::string refusal(curtain::Simulator& simulator, const curtain::GraspParams& grasp) {
  const std::vector<curtain::Problem> problems = simulator.setGrasp(grasp);
  return problems.empty() ? "" : problems.front().key + " " + problems.front().text;
}

}  // namespace curtain_test
