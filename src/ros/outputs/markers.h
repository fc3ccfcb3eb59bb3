// SPDX-License-Identifier: BSD-3-Clause
//
// The curtain as rviz markers. The mesh is one TRIANGLE_LIST; the rest is a MarkerArray whose namespaces can
// be switched on and off in rviz:
//
//   wires      the links of the grid            nodes      first-layer nodes
//   folds      second-layer nodes               wind       cones of the sources that blow now
//   obstacles  the shapes that are present
//   rail       its path                          carriers   on it
//   lines      lines and closed tie-backs, and the loads
//   grasps     nodes that hands hold
//   contacts   arrows: forces of the cloth on obstacles, where they are asked for
//
// Messages are filled again only where the picture has changed.
#pragma once

#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/mesh_reducer.h"
#include "ros/outputs/geometry_cache.h"
#include "ros/outputs/reused_message.h"

namespace curtain_ros {

/// The curtain's fine mesh. One thread at a time.
class MeshMarker {
 public:
  /// geometry must outlive this.
  MeshMarker(const std::string& world_frame, GeometryCache& geometry);

  /// Compares with the simulator; a number that changes whenever the picture may have changed.
  std::uint64_t update(const curtain::MeshDetail& detail);

  /// The picture of the last update() as a message.
  visualization_msgs::Marker::ConstPtr build(const ros::Time& stamp);

 private:
  void fill(visualization_msgs::Marker& marker);

  GeometryCache& geometry_;
  std::uint64_t picture_ = 0;
  std::optional<std::uint64_t> revision_;  // of that picture
  curtain::MeshDetail detail_;             // and its detail
  curtain::MeshReducer reducer_;
  std::vector<curtain::Vec3> normals_;        // of the fine nodes
  std::vector<std_msgs::ColorRGBA> colours_;  // the same
  std::uint64_t filled_ = 0;                  // picture in the message
  ReusedMessage<visualization_msgs::Marker> message_;
};

/// Everything else. One thread at a time.
class DetailMarkers {
 public:
  /// geometry must outlive this.
  DetailMarkers(const std::string& world_frame, GeometryCache& geometry, bool contact_points);

  /// The same as MeshMarker's.
  std::uint64_t update();

  /// The picture of the last update() as a message.
  visualization_msgs::MarkerArray::ConstPtr build(const ros::Time& stamp);

 private:
  void fill(visualization_msgs::MarkerArray& array);

  GeometryCache& geometry_;
  bool contact_points_;
  std::vector<std::array<std::size_t, 2>> links_;  // nodes that they join
  std::vector<curtain::ContactForce> forces_;
  std::uint64_t picture_ = 0;
  std::optional<std::uint64_t> revision_, filled_;  // of that picture; of the array, without its wind
  // Winds come and go without a new revision. They are few: their lines are compared.
  std::vector<geometry_msgs::Point> cones_, cones_now_;
  std::vector<std::vector<curtain::Vec3>> obstacle_normals_;  // at their triangles' corners
  ReusedMessage<visualization_msgs::MarkerArray> message_;
};

}  // namespace curtain_ros
