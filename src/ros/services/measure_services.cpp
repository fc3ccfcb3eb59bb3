// SPDX-License-Identifier: BSD-3-Clause
#include "ros/services/measure_services.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "ros/frames/geometry.h"
#include "ros/services/control_services.h"

namespace curtain_ros {
namespace {

std::vector<std::string> obstaclesOf(const curtain::Scene& scene) {
  std::vector<std::string> names;
  for (const curtain::ObstacleParams& obstacle : scene.obstacles) names.push_back(obstacle.name);
  return names;
}

}  // namespace

MeasureServices::MeasureServices(const ros::NodeHandle& private_node, Calls& calls, const curtain::Simulator& simulator,
                                 std::string world)
    : calls_(calls),
      simulator_(simulator),
      known_(obstaclesOf(simulator.scene())),
      world_(std::move(world)),
      thread_(private_node, 1) {
  distance_ = thread_.node().advertiseService("distance", &MeasureServices::distance, this);
  thread_.start();
}

bool MeasureServices::distance(curtain_sim::Distance::Request& request, curtain_sim::Distance::Response& response) {
  response.names = request.obstacles.empty() ? known_ : request.obstacles;
  for (const std::string& name : response.names) {
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    response.names.clear();
    response.message = "there is no obstacle '" + name + (known_.empty() ? "': the scene has none" : "', known are");
    for (const std::string& each : known_) response.message += " '" + each + "'";
    return true;
  }
  response.frame_id = world_;
  const bool measured = calls_.run([&] {
    for (const std::string& name : response.names) measure(name, response);
    response.simulated_time = simulator_.time();
  });
  if (!measured) response.message = kStops;
  response.success = measured;
  return true;
}

void MeasureServices::measure(const std::string& name, curtain_sim::Distance::Response& response) const {
  const auto found = std::find(known_.begin(), known_.end(), name);
  const curtain::ObstacleDistance nearest = simulator_.obstacleDistance(static_cast<int>(found - known_.begin()));
  response.distances.push_back(nearest.distance);
  response.on_cloth.push_back(toPoint(nearest.on_cloth));
  response.on_obstacle.push_back(toPoint(nearest.on_obstacle));
}

}  // namespace curtain_ros
