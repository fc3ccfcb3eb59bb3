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
    : calls_(calls), simulator_(simulator), world_(std::move(world)), thread_(private_node, 1) {
  distance_ = thread_.node().advertiseService("distance", &MeasureServices::distance, this);
  thread_.start();
}

// The names of a node's obstacles never change, so they are judged by this thread.
bool MeasureServices::distance(curtain_sim::Distance::Request& request, curtain_sim::Distance::Response& response) {
  const std::vector<std::string> known = obstaclesOf(simulator_.scene());
  response.names = request.obstacles.empty() ? known : request.obstacles;
  for (const std::string& name : response.names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    response.names.clear();
    response.message = "there is no obstacle '" + name + (known.empty() ? "': the scene has none" : "', known are");
    for (const std::string& each : known) response.message += " '" + each + "'";
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
  const std::vector<curtain::ObstacleParams>& all = simulator_.scene().obstacles;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.name == name; });
  const curtain::ObstacleDistance nearest = simulator_.obstacleDistance(static_cast<int>(found - all.begin()));
  response.distances.push_back(nearest.distance);
  response.on_cloth.push_back(toPoint(nearest.on_cloth));
  response.on_obstacle.push_back(toPoint(nearest.on_obstacle));
}

}  // namespace curtain_ros
