// SPDX-License-Identifier: BSD-3-Clause
//
// Floor 5: the curtain as rviz markers. The mesh is one TRIANGLE_LIST; the rest is a MarkerArray whose namespaces can
// be switched on and off in rviz:
//
//   wires      the links of the grid            nodes      first-layer nodes
//   folds      second-layer nodes               wind       cones of the sources that blow now
//   obstacles  the shapes that are present
//
// Messages are filled again only where the picture has changed since they were filled last.
#pragma once

#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "curtain_sim/mesh_reducer.h"
#include "ros/outputs/geometry_cache.h"
#include "ros/outputs/message_pool.h"

namespace curtain_ros {

/// The curtain's fine mesh. One thread at a time.
class MeshMarker {
 public:
  /// shape must outlive this.
  MeshMarker(const std::string& world_frame, Shape& shape);

  /// The number of the picture that there is now, in this detail; another number, another picture.
  std::uint64_t look(const curtain::MeshDetail& detail);

  /// The picture that was looked at last, as a message.
  visualization_msgs::Marker::ConstPtr build(const ros::Time& stamp);

 private:
  void draw();
  void fill(visualization_msgs::Marker& marker) const;

  Shape& shape_;
  std::uint64_t picture_ = 0;
  std::optional<std::uint64_t> revision_;  // of that picture
  curtain::MeshDetail detail_;             // and its detail
  curtain::MeshReducer reducer_;
  std::optional<std::uint64_t> drawn_;  // picture that the following are of
  const curtain::MeshReducer::Triangles* triangles_ = nullptr;
  std::vector<curtain::Vec3> normals_;
  std::vector<std_msgs::ColorRGBA> colours_;                                    // of the fine nodes
  MessagePool<visualization_msgs::Marker, std::optional<std::uint64_t>> pool_;  // content: picture
};

/// Everything else. One thread at a time.
class DetailMarkers {
 public:
  /// shape must outlive this.
  DetailMarkers(const std::string& world_frame, Shape& shape);

  /// The number of the picture that there is now; another number, another picture.
  std::uint64_t look();

  /// The picture that was looked at last, as a message.
  visualization_msgs::MarkerArray::ConstPtr build(const ros::Time& stamp);

 private:
  struct Content {
    std::optional<std::uint64_t> shape;  // revision
    std::optional<std::uint64_t> winds;  // number
  };

  void fill(visualization_msgs::MarkerArray& array);
  void place(visualization_msgs::Marker& marker, int obstacle) const;

  Shape& shape_;
  std::uint64_t picture_ = 0;
  std::optional<std::uint64_t> revision_;  // of that picture
  // Winds come and go without a new revision. They are few: their lines are compared.
  std::uint64_t winds_ = 0;  // number of cones_
  std::vector<geometry_msgs::Point> cones_, cones_now_;
  MessagePool<visualization_msgs::MarkerArray, Content> pool_;
};

}  // namespace curtain_ros
