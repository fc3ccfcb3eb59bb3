// SPDX-License-Identifier: BSD-3-Clause
#include "ros/outputs/markers.h"

#include <cmath>

#include "obstacles/corner_normals.h"
#include "ros/frames/geometry.h"
#include "ros/outputs/shape_light.h"
#include "scene/pi.h"

namespace curtain_ros {

using curtain::Vec3;
using visualization_msgs::Marker;

namespace {

// Places in the array; obstacles follow.
enum Slot { kWires, kNodes, kFolds, kWind, kRail, kCarriers, kLines, kLoads, kGrasps, kContacts, kFirstObstacle };

// Sizes in the picture [m].
constexpr double kWireWidth = 0.002;
constexpr double kNodeSize = 0.012;
constexpr double kFoldSize = 0.006;
constexpr double kWindWidth = 0.004;
constexpr double kRailWidth = 0.02;
constexpr double kCarrierSize = 0.024;
constexpr double kLineWidth = 0.006;
constexpr double kLoadSize = 0.12;
constexpr double kGraspSize = 0.03;
constexpr double kArrowWidth = 0.003;
constexpr double kLongestArrow = 0.25;
constexpr double kHalfArrow = 0.1;   // [N] whose arrow is half as long
constexpr double kRailStep = 0.05;   // from point to point
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

// brightness: cosine between light and normal, of either side
std_msgs::ColorRGBA shaded(const std_msgs::ColorRGBA& c, double brightness) {
  const float light = kAmbient + (1.0F - kAmbient) * static_cast<float>(brightness);
  return colour(light * c.r, light * c.g, light * c.b);
}

// Rviz reports markers without points as errors: an empty one is deleted instead.
void showUnlessEmpty(Marker& marker) { marker.action = marker.points.empty() ? Marker::DELETE : Marker::ADD; }

using Points = std::vector<geometry_msgs::Point>;

void addLine(const Vec3& a, const Vec3& b, Points& points) {
  points.push_back(toPoint(a));
  points.push_back(toPoint(b));
}

// From the nodes to where they end.
void buildLines(const curtain::Simulator& simulator, Points& lines, Points& loads) {
  lines.clear();
  loads.clear();
  for (const curtain::LineParams& line : simulator.scene().lines) {
    const Vec3 end = simulator.lineEnd(line.id).value_or(Vec3::Zero());
    for (const curtain::NodeIndex& node : line.nodes) addLine(simulator.position(node), end, lines);
    if (line.mass) loads.push_back(toPoint(end));
  }
  for (const curtain::TieBackParams& loop : simulator.scene().tie_back) {
    if (!simulator.tieBackClosed(loop.id)) continue;
    for (int column = loop.first_column; column <= loop.last_column; ++column)
      addLine(simulator.position({loop.row, column}), loop.point, lines);
  }
}

void buildGrasps(const curtain::Simulator& simulator, Points& points) {
  points.clear();
  for (const std::string& id : simulator.grasps()) {
    const std::optional<curtain::GraspState> grasp = simulator.graspState(id);
    for (const curtain::NodeIndex& node : grasp->nodes) points.push_back(toPoint(simulator.position(node)));
  }
}

// Arrows to where the cloth presses, along its force. Forces of a node's weight and of a fist can both be seen.
void buildArrows(const std::vector<curtain::ContactForce>& forces, Points& points) {
  points.clear();
  for (const curtain::ContactForce& contact : forces) {
    const Vec3 force = contact.friction - contact.normal_force * contact.normal;
    const double size = force.norm();
    const Vec3 along = kLongestArrow / (size + kHalfArrow) * force;
    const Vec3 aside = 0.15 * along.norm() * along.unitOrthogonal();
    const Vec3& tip = contact.position;
    addLine(tip - along, tip, points);
    for (const double side : {1.0, -1.0}) addLine(tip - 0.3 * along + side * aside, tip, points);
  }
}

// Nodes that links join, but for those that slits cut.
std::vector<std::array<std::size_t, 2>> linksOf(const curtain::ClothParams& cloth) {
  std::vector<int> cut_from(static_cast<std::size_t>(cloth.columns), cloth.rows);  // on the right of each column
  for (const curtain::SlitParams& slit : cloth.slits) cut_from[static_cast<std::size_t>(slit.column)] = slit.from_row;
  const auto at = [&](int row, int column) {
    return static_cast<std::size_t>(row) * cut_from.size() + static_cast<std::size_t>(column % cloth.columns);
  };
  std::vector<std::array<std::size_t, 2>> links;
  for (int row = 0; row < cloth.rows; ++row) {
    for (int column = 0; column < cloth.columns; ++column) {
      if (row + 1 < cloth.rows) links.push_back({at(row, column), at(row + 1, column)});
      const bool goes_on = column + 1 < cloth.columns || cloth.closed;
      if (goes_on && row < cut_from[static_cast<std::size_t>(column)])
        links.push_back({at(row, column), at(row, column + 1)});
    }
  }
  return links;
}

// Disc, spokes and the circle at the end of the drawn part.
void addCone(const curtain::WindParams& wind, Points& points) {
  const Vec3 axis = wind.direction.normalized();
  const Vec3 u = axis.unitOrthogonal();
  const Vec3 v = axis.cross(u);
  const double far_radius = wind.radius + kWindLength * std::tan(wind.half_angle);
  const auto corner = [&](int spoke, double along, double radius) -> Vec3 {
    const double angle = 2.0 * curtain::kPi * spoke / kWindSpokes;
    return wind.position + along * axis + radius * (std::cos(angle) * u + std::sin(angle) * v);
  };
  for (int i = 0; i < kWindSpokes; ++i) {
    addLine(corner(i, 0.0, wind.radius), corner(i + 1, 0.0, wind.radius), points);
    addLine(corner(i, kWindLength, far_radius), corner(i + 1, kWindLength, far_radius), points);
    addLine(corner(i, 0.0, wind.radius), corner(i, kWindLength, far_radius), points);
  }
}

void addTriangles(const std::vector<Vec3>& corners, const std::vector<Eigen::Vector3i>& triangles, Points& points) {
  points.reserve(3 * triangles.size());
  for (const Eigen::Vector3i& triangle : triangles) {
    for (int k = 0; k < 3; ++k) points.push_back(toPoint(corners[static_cast<std::size_t>(triangle[k])]));
  }
}

visualization_msgs::MarkerArray blankDetails(const std::string& frame, const curtain::Simulator& simulator) {
  visualization_msgs::MarkerArray array;
  array.markers = {
      makeMarker(frame, "wires", Marker::LINE_LIST, kWireWidth, colour(0.95F, 0.95F, 0.95F)),
      makeMarker(frame, "nodes", Marker::POINTS, kNodeSize, colour(0.10F, 0.75F, 0.95F)),
      makeMarker(frame, "folds", Marker::POINTS, kFoldSize, colour(0.95F, 0.85F, 0.30F)),
      makeMarker(frame, "wind", Marker::LINE_LIST, kWindWidth, colour(0.55F, 0.80F, 1.00F)),
      makeMarker(frame, "rail", Marker::LINE_LIST, kRailWidth, colour(0.62F, 0.63F, 0.66F)),
      makeMarker(frame, "carriers", Marker::SPHERE_LIST, kCarrierSize, colour(0.86F, 0.87F, 0.90F)),
      makeMarker(frame, "lines", Marker::LINE_LIST, kLineWidth, colour(0.80F, 0.72F, 0.52F)),
      makeMarker(frame, "lines", Marker::SPHERE_LIST, kLoadSize, colour(0.35F, 0.33F, 0.32F)),
      makeMarker(frame, "grasps", Marker::SPHERE_LIST, kGraspSize, colour(0.98F, 0.62F, 0.12F)),
  };
  array.markers.push_back(makeMarker(frame, "contacts", Marker::LINE_LIST, kArrowWidth, colour(1.00F, 0.55F, 0.10F)));
  array.markers[kLoads].id = 1;
  for (const curtain::Simulator::LayerColumns& layer : simulator.layers()) {
    const std::vector<Vec3> points = simulator.railPoints(kRailStep, layer.name);
    for (std::size_t k = 1; k < points.size(); ++k) addLine(points[k - 1], points[k], array.markers[kRail].points);
  }
  for (const Slot slot : {kRail, kCarriers}) showUnlessEmpty(array.markers[slot]);
  for (int i = 0; i < simulator.obstacleCount(); ++i) {  // shapes never change: their triangles are made once
    Marker marker = makeMarker(frame, "obstacles", Marker::TRIANGLE_LIST, 1.0, colour(1.0F, 1.0F, 1.0F));
    marker.id = i;
    const curtain::ShapeTriangles shape = simulator.obstacleShape(i).triangles();
    addTriangles(shape.corners, shape.triangles, marker.points);
    array.markers.push_back(marker);
  }
  return array;
}

}  // namespace

MeshMarker::MeshMarker(const std::string& world_frame, GeometryCache& geometry)
    : geometry_(geometry),
      reducer_(geometry.simulator().fineMeshTopology()),
      message_(makeMarker(world_frame, "mesh", Marker::TRIANGLE_LIST, 1.0, kCloth)) {}

std::uint64_t MeshMarker::update(const curtain::MeshDetail& detail) {
  if (revision_ != geometry_.revision() || !(detail_ == detail)) ++picture_;
  revision_ = geometry_.revision();
  detail_ = detail;
  return picture_;
}

Marker::ConstPtr MeshMarker::build(const ros::Time& stamp) {
  const auto marker = message_.edit();
  if (filled_ != picture_) fill(*marker);
  filled_ = picture_;
  marker->header.stamp = stamp;
  return marker;
}

// Rviz lights triangles from one side, flat, and would show the back of the cloth black; so the light is in the
// vertices' colours, smooth and the same on both sides.
void MeshMarker::fill(Marker& marker) {
  const curtain::FineMesh& mesh = geometry_.fineMesh();
  const curtain::MeshReducer::Triangles& triangles = reducer_.reduce(mesh, detail_);
  curtain::fineMeshNormals(triangles, mesh, normals_);
  colours_.clear();
  for (const Vec3& normal : normals_) colours_.push_back(shaded(kCloth, std::abs(normal.dot(kLight))));
  marker.points.resize(3 * triangles.size());
  marker.colors.resize(marker.points.size());
  std::size_t to = 0;
  for (const auto& triangle : triangles) {
    for (const std::uint32_t node : triangle) {
      marker.points[to] = toPoint(mesh.positions[node]);
      marker.colors[to++] = colours_[node];
    }
  }
}

DetailMarkers::DetailMarkers(const std::string& world_frame, GeometryCache& geometry, bool contact_points)
    : geometry_(geometry),
      contact_points_(contact_points),
      links_(linksOf(wholeCloth(geometry.simulator().scene()))),
      message_(blankDetails(world_frame, geometry.simulator())) {
  for (int i = 0; i < geometry.simulator().obstacleCount(); ++i)
    obstacle_normals_.push_back(cornerNormals(geometry.simulator().obstacleShape(i).triangles()));
}

std::uint64_t DetailMarkers::update() {
  const curtain::Simulator& simulator = geometry_.simulator();
  cones_now_.clear();
  for (const curtain::WindParams& source : simulator.winds()) {
    if (blows(source, simulator.time())) addCone(source, cones_now_);
  }
  if (cones_now_ != cones_ || revision_ != geometry_.revision()) ++picture_;
  std::swap(cones_, cones_now_);
  revision_ = geometry_.revision();
  return picture_;
}

visualization_msgs::MarkerArray::ConstPtr DetailMarkers::build(const ros::Time& stamp) {
  const auto array = message_.edit();
  if (filled_ != revision_) fill(*array);
  filled_ = revision_;
  array->markers[kWind].points = cones_;
  showUnlessEmpty(array->markers[kWind]);
  for (Marker& marker : array->markers) marker.header.stamp = stamp;
  return array;
}

void DetailMarkers::fill(visualization_msgs::MarkerArray& array) {
  const curtain::Simulator& simulator = geometry_.simulator();
  const std::vector<Vec3>& positions = geometry_.nodes();
  Points& wires = array.markers[kWires].points;
  wires.clear();
  for (const auto& [from, to] : links_) addLine(positions[from], positions[to], wires);

  Points& nodes = array.markers[kNodes].points;
  nodes.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) nodes[i] = toPoint(positions[i]);

  Marker& carriers = array.markers[kCarriers];
  carriers.points.clear();
  for (const curtain::NodeIndex& node : simulator.carriers())
    carriers.points.push_back(toPoint(simulator.position(node)));
  showUnlessEmpty(carriers);

  buildLines(simulator, array.markers[kLines].points, array.markers[kLoads].points);
  buildGrasps(simulator, array.markers[kGrasps].points);
  if (contact_points_) simulator.copyContactPoints(forces_);
  buildArrows(forces_, array.markers[kContacts].points);
  for (const Slot slot : {kLines, kLoads, kGrasps, kContacts}) showUnlessEmpty(array.markers[slot]);

  const curtain::FineMesh& mesh = geometry_.fineMesh();
  const curtain::FineMeshTopology& topology = simulator.fineMeshTopology();
  Marker& folds = array.markers[kFolds];
  folds.points.clear();
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const int column = static_cast<int>(i % static_cast<std::size_t>(topology.columns));
    if (column % topology.folds != 0) folds.points.push_back(toPoint(mesh.positions[i]));
  }
  showUnlessEmpty(folds);

  for (int i = 0; i < simulator.obstacleCount(); ++i) {
    Marker& obstacle = array.markers[static_cast<std::size_t>(kFirstObstacle) + static_cast<std::size_t>(i)];
    const curtain::ObstacleParams& params = simulator.scene().obstacles[static_cast<std::size_t>(i)];
    const curtain::Pose pose = simulator.obstaclePose(i);
    obstacle.action = params.visible && simulator.obstaclePresent(i) ? Marker::ADD : Marker::DELETE;
    const geometry_msgs::Quaternion was = obstacle.pose.orientation;
    obstacle.pose = toPose(pose);
    if (!obstacle.colors.empty() && was == obstacle.pose.orientation) continue;
    obstacle.colors.clear();
    for (const Vec3& normal : obstacle_normals_[static_cast<std::size_t>(i)])
      obstacle.colors.push_back(litColour(params.color, pose.orientation * normal));
  }
}

}  // namespace curtain_ros
