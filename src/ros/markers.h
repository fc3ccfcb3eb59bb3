// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: the curtain as rviz markers. The mesh is one TRIANGLE_LIST that is built into the same message for ever;
// the rest is a MarkerArray whose namespaces can be switched on and off in rviz:
//
//   wires      the links of the grid            nodes      first-layer nodes
//   folds      second-layer nodes               wind       cones of the sources that blow now
//   obstacles  the shapes that are present
#pragma once

#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <string>
#include <vector>

#include "curtain_sim/simulator.h"

namespace curtain_ros {

/// The curtain's fine mesh. One thread at a time.
class MeshMarker {
 public:
  explicit MeshMarker(const std::string& world_frame);

  /// The message of a frame; valid until the next call.
  const visualization_msgs::Marker& build(const curtain::Simulator& simulator, const ros::Time& stamp);

 private:
  visualization_msgs::Marker marker_;
  curtain::FineMesh mesh_;
  std::vector<curtain::Vec3> normals_;
};

/// Everything else. One thread at a time.
class DetailMarkers {
 public:
  explicit DetailMarkers(const std::string& world_frame);

  /// The message of a frame; valid until the next call.
  const visualization_msgs::MarkerArray& build(const curtain::Simulator& simulator, const ros::Time& stamp);

 private:
  void buildObstacle(const curtain::Simulator& simulator, int index);

  visualization_msgs::MarkerArray array_;
  curtain::FineMesh mesh_;
  std::vector<curtain::Vec3> nodes_;
};

}  // namespace curtain_ros
