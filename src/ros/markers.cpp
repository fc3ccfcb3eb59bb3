// SPDX-License-Identifier: BSD-3-Clause
#include "ros/markers.h"

#include <cmath>

#include "ros/conversions.h"

namespace curtain_ros {

using curtain::Vec3;
using visualization_msgs::Marker;

namespace {

// Places in the array; obstacles follow.
enum Slot { kWires, kNodes, kFolds, kWind, kFirstObstacle };

// Sizes in the picture [m].
constexpr double kWireWidth = 0.002;
constexpr double kNodeSize = 0.012;
constexpr double kFoldSize = 0.006;
constexpr double kWindWidth = 0.004;
constexpr double kWindLength = 0.5;  // of the drawn part of a cone
constexpr int kWindSpokes = 12;

std_msgs::ColorRGBA colour(float r, float g, float b) {
  std_msgs::ColorRGBA c;
  c.r = r;
  c.g = g;
  c.b = b;
  c.a = 1.0F;  // less than 1 would stop rviz from writing depth
  return c;
}

Marker makeMarker(const std::string& frame, const std::string& name_space, int type, double size,
                  const std_msgs::ColorRGBA& c) {
  Marker marker;
  marker.header.frame_id = frame;
  marker.ns = name_space;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = size;
  marker.color = c;
  return marker;
}

const std_msgs::ColorRGBA kCloth = colour(0.85F, 0.20F, 0.24F);
const Vec3 kLight = Vec3(0.45, -0.75, 0.5).normalized();
constexpr float kAmbient = 0.25F;

// brightness: cosine between light and normal, either side.
std_msgs::ColorRGBA shaded(const std_msgs::ColorRGBA& c, double brightness) {
  const float light = kAmbient + (1.0F - kAmbient) * static_cast<float>(brightness);
  return colour(light * c.r, light * c.g, light * c.b);
}

// rviz complains about markers without points: an empty one is taken away instead.
void showUnlessEmpty(Marker& marker) { marker.action = marker.points.empty() ? Marker::DELETE : Marker::ADD; }

void addLine(const Vec3& a, const Vec3& b, Marker& marker) {
  marker.points.push_back(toPoint(a));
  marker.points.push_back(toPoint(b));
}

void buildWires(const std::vector<Vec3>& nodes, int rows, int columns, bool closed, Marker& marker) {
  const auto at = [&](int row, int column) -> const Vec3& {
    return nodes[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  };
  marker.points.clear();
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      if (row + 1 < rows) addLine(at(row, column), at(row + 1, column), marker);
      if (column + 1 < columns) addLine(at(row, column), at(row, column + 1), marker);
    }
    if (closed) addLine(at(row, columns - 1), at(row, 0), marker);
  }
}

// Disc, spokes and the circle at the end of the drawn part.
void addCone(const curtain::WindParams& wind, Marker& marker) {
  const Vec3 axis = wind.direction.normalized();
  const Vec3 u = axis.unitOrthogonal();
  const Vec3 v = axis.cross(u);
  const double far_radius = wind.radius + kWindLength * std::tan(wind.half_angle);
  const auto corner = [&](int spoke, double along, double radius) -> Vec3 {
    const double angle = 2.0 * M_PI * spoke / kWindSpokes;
    return wind.position + along * axis + radius * (std::cos(angle) * u + std::sin(angle) * v);
  };
  for (int i = 0; i < kWindSpokes; ++i) {
    addLine(corner(i, 0.0, wind.radius), corner(i + 1, 0.0, wind.radius), marker);
    addLine(corner(i, kWindLength, far_radius), corner(i + 1, kWindLength, far_radius), marker);
    addLine(corner(i, 0.0, wind.radius), corner(i, kWindLength, far_radius), marker);
  }
}

void addTriangles(const std::vector<Vec3>& corners, const std::vector<Eigen::Vector3i>& triangles, Marker& marker) {
  marker.points.reserve(3 * triangles.size());
  for (const Eigen::Vector3i& triangle : triangles) {
    for (const int corner : triangle) marker.points.push_back(toPoint(corners[static_cast<std::size_t>(corner)]));
  }
}

}  // namespace

MeshMarker::MeshMarker(const std::string& world_frame)
    : marker_(makeMarker(world_frame, "mesh", Marker::TRIANGLE_LIST, 1.0, kCloth)) {}

// rviz lights triangles from one side, flat, and would show the back of the cloth black; so the light is in the vertices'
// colours, smooth and the same on both sides.
const Marker& MeshMarker::build(const curtain::Simulator& simulator, const ros::Time& stamp) {
  const curtain::FineMeshTopology& topology = simulator.fineMeshTopology();
  simulator.copyFineMesh(mesh_);
  curtain::fineMeshNormals(topology, mesh_, normals_);
  marker_.header.stamp = stamp;
  marker_.points.resize(3 * topology.triangles.size());
  marker_.colors.resize(marker_.points.size());
  std::size_t to = 0;
  for (const auto& triangle : topology.triangles) {
    for (const std::uint32_t node : triangle) {
      marker_.points[to] = toPoint(mesh_.positions[node]);
      marker_.colors[to++] = shaded(kCloth, std::abs(normals_[node].dot(kLight)));
    }
  }
  return marker_;
}

DetailMarkers::DetailMarkers(const std::string& world_frame) {
  array_.markers = {
      makeMarker(world_frame, "wires", Marker::LINE_LIST, kWireWidth, colour(0.95F, 0.95F, 0.95F)),
      makeMarker(world_frame, "nodes", Marker::POINTS, kNodeSize, colour(0.10F, 0.75F, 0.95F)),
      makeMarker(world_frame, "folds", Marker::POINTS, kFoldSize, colour(0.95F, 0.85F, 0.30F)),
      makeMarker(world_frame, "wind", Marker::LINE_LIST, kWindWidth, colour(0.55F, 0.80F, 1.00F)),
  };
}

const visualization_msgs::MarkerArray& DetailMarkers::build(const curtain::Simulator& simulator,
                                                            const ros::Time& stamp) {
  simulator.copyPositions(nodes_);
  buildWires(nodes_, simulator.rows(), simulator.columns(), simulator.scene().cloth.closed, array_.markers[kWires]);

  Marker& nodes = array_.markers[kNodes];
  nodes.points.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) nodes.points[i] = toPoint(nodes_[i]);

  simulator.copyFineMesh(mesh_);
  const curtain::FineMeshTopology& topology = simulator.fineMeshTopology();
  Marker& folds = array_.markers[kFolds];
  folds.points.clear();
  for (std::size_t i = 0; i < mesh_.positions.size(); ++i) {
    const int column = static_cast<int>(i % static_cast<std::size_t>(topology.columns));
    if (column % topology.folds != 0) folds.points.push_back(toPoint(mesh_.positions[i]));
  }
  showUnlessEmpty(folds);

  Marker& wind = array_.markers[kWind];
  wind.points.clear();
  for (const curtain::WindParams& source : simulator.winds()) {
    if (source.start <= simulator.time() && simulator.time() < source.end) addCone(source, wind);
  }
  showUnlessEmpty(wind);

  for (int i = 0; i < simulator.obstacleCount(); ++i) buildObstacle(simulator, i);
  for (Marker& marker : array_.markers) marker.header.stamp = stamp;
  return array_;
}

void DetailMarkers::buildObstacle(const curtain::Simulator& simulator, int index) {
  const std::size_t slot = static_cast<std::size_t>(kFirstObstacle) + static_cast<std::size_t>(index);
  if (slot >= array_.markers.size()) {  // shapes never change: their triangles are made once
    Marker marker = makeMarker(array_.markers[kWires].header.frame_id, "obstacles", Marker::TRIANGLE_LIST, 1.0,
                               colour(0.45F, 0.50F, 0.58F));
    marker.id = index;
    const curtain::ShapeTriangles shape = simulator.obstacleShape(index).triangles();
    addTriangles(shape.corners, shape.triangles, marker);
    array_.markers.push_back(marker);
  }
  Marker& marker = array_.markers[slot];
  const curtain::Pose& pose = simulator.obstaclePose(index);
  marker.action = simulator.obstaclePresent(index) ? Marker::ADD : Marker::DELETE;
  marker.pose.position = toPoint(pose.position);
  marker.pose.orientation.x = pose.orientation.x();
  marker.pose.orientation.y = pose.orientation.y();
  marker.pose.orientation.z = pose.orientation.z();
  marker.pose.orientation.w = pose.orientation.w();
}

}  // namespace curtain_ros
