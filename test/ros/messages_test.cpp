// SPDX-License-Identifier: BSD-3-Clause
//
// Messages that are filled again and again: each holds what a new one would, what has not changed is left in it, one
// that somebody holds is left alone, and once all have been seen nothing is allocated. No ROS master needed.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "count_allocations.h"
#include "figures.h"
#include "ros/frames/geometry.h"
#include "ros/outputs/markers.h"
#include "ros/outputs/state_messages.h"
#include "simulator/scenes.h"
#include "testing.h"

namespace curtain_ros {
namespace {

using curtain::Vec3;
using curtain_test::shippedScene;

curtain::Scene smallScene() {
  curtain::Scene scene;
  scene.cloth.rows = 6;
  scene.cloth.columns = 5;
  scene.hang.to.x() = 0.6;
  scene.obstacles.push_back(curtain_test::ballAt({0.3, 0.4, 1.5}, 0.1));
  return scene;
}

curtain::WindParams fan(double pressure) {
  curtain::WindParams wind = curtain_test::fanAt({0.3, -1.0, 1.5}, 0.5);
  wind.pressure = pressure;
  return wind;
}

/// All that the node publishes of a simulator.
class Messages {
 public:
  explicit Messages(const curtain::Simulator& simulator)
      : geometry(simulator),
        state(withFolds(), geometry),
        loads(withFolds(), simulator),
        contacts(withFolds()),
        mesh("world", geometry),
        details("world", geometry, false) {}

  visualization_msgs::Marker::ConstPtr buildMesh() {
    mesh.update(detail);
    return mesh.build(stamp);
  }
  visualization_msgs::MarkerArray::ConstPtr buildDetails() {
    details.update();
    return details.build(stamp);
  }
  void buildAll() {
    state.build(stamp, {});
    loads.build(stamp);
    contacts.build(geometry.simulator(), stamp);
    buildMesh();
    buildDetails();
  }

  GeometryCache geometry;
  StateMessages state;
  LoadMessages loads;
  ContactMessages contacts;
  MeshMarker mesh;
  DetailMarkers details;
  ros::Time stamp{1.0};
  curtain::MeshDetail detail;

 private:
  static NodeParams withFolds() {
    NodeParams params;
    params.state_folds = true;
    return params;
  }
};

/// What is filled must be what a new one holds.
void expectAsNew(Messages& messages) {
  Messages fresh(messages.geometry.simulator());
  fresh.stamp = messages.stamp;
  EXPECT_TRUE(*messages.state.build(messages.stamp, {}) == *fresh.state.build(fresh.stamp, {}));
  EXPECT_TRUE(*messages.loads.build(messages.stamp) == *fresh.loads.build(fresh.stamp));
  EXPECT_TRUE(*messages.contacts.build(messages.geometry.simulator(), messages.stamp) ==
              *fresh.contacts.build(messages.geometry.simulator(), fresh.stamp));
  EXPECT_TRUE(*messages.buildMesh() == *fresh.buildMesh());
  EXPECT_TRUE(*messages.buildDetails() == *fresh.buildDetails());
}

TEST(Messages, SteadyOnesAllocateNothing) {
  for (const char* name : {"curtain", "flag", "skirt"}) {
    curtain::Simulator simulator(shippedScene(name));
    Messages messages(simulator), reduced(simulator);
    reduced.detail.tolerance = 1e-3;
    long built = 0;
    for (int frame = 0; frame < 90; ++frame) {
      simulator.step();
      const long before = allocations;
      messages.buildAll();
      reduced.buildAll();
      if (frame >= 30) built += allocations - before;
    }
    EXPECT_EQ(built, 0) << name;
  }
}

TEST(Messages, HoldWhatNewOnesWouldWhateverChanges) {
  curtain::Simulator simulator(smallScene());
  Messages messages(simulator);
  expectAsNew(messages);
  simulator.step();
  expectAsNew(messages);
  simulator.setWind(fan(5.0));  // no new shape, but new cones
  expectAsNew(messages);
  simulator.step();
  simulator.setObstaclePresent(0, false);
  expectAsNew(messages);
  simulator.removeWind("fan");
  expectAsNew(messages);
  simulator.setObstaclePresent(0, true);
  simulator.setObstaclePose(0, curtain::Pose(), true);
  expectAsNew(messages);
  simulator.setObstaclePose(0, {curtain::Vec3::Zero(), Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0)}, true);
  simulator.step();
  expectAsNew(messages);  // other light
  simulator.reset();
  expectAsNew(messages);
}

// A subscriber of this process gets the object itself and may keep it.
TEST(Messages, OneThatIsHeldIsLeftAlone) {
  curtain::Simulator simulator(smallScene());
  Messages messages(simulator);
  simulator.step();
  const auto state = messages.state.build(messages.stamp, {});
  const auto contacts = messages.contacts.build(simulator, messages.stamp);
  const auto mesh = messages.buildMesh();
  const auto details = messages.buildDetails();
  const auto kept_state = *state;
  const auto kept_contacts = *contacts;
  const auto kept_mesh = *mesh;
  const auto kept_details = *details;
  for (int frame = 0; frame < 3; ++frame) {
    simulator.step();
    messages.stamp += ros::Duration(1.0);
    expectAsNew(messages);
  }
  EXPECT_TRUE(*state == kept_state);
  EXPECT_TRUE(*contacts == kept_contacts);
  EXPECT_TRUE(*mesh == kept_mesh);
  EXPECT_TRUE(*details == kept_details);
}

// Where a message is not filled again, a mark that was set in it stays.
TEST(Messages, OfTheSameShapeAreNotFilledAgain) {
  curtain::Simulator simulator(smallScene());
  Messages messages(simulator);
  simulator.setWind(fan(0.0));
  messages.buildAll();
  const double mark = 1e6;
  const auto wires = [](const visualization_msgs::MarkerArray& array) -> const visualization_msgs::Marker& {
    return array.markers[0];
  };
  const_cast<double&>(messages.buildMesh()->points[0].x) = mark;
  const_cast<float&>(messages.state.build(messages.stamp, {})->forces[0]) = 1e6F;
  const_cast<double&>(wires(*messages.buildDetails()).points[0].x) = mark;
  messages.stamp = ros::Time(2.0);
  EXPECT_EQ(messages.buildMesh()->points[0].x, mark);
  EXPECT_EQ(messages.buildMesh()->header.stamp, messages.stamp);
  EXPECT_EQ(messages.state.build(messages.stamp, {})->forces[0], 1e6F);
  EXPECT_EQ(messages.state.build(messages.stamp, {})->header.stamp, messages.stamp);
  simulator.removeWind("fan");
  EXPECT_EQ(wires(*messages.buildDetails()).points[0].x, mark) << "other winds, the same wires";
  EXPECT_EQ(wires(*messages.buildDetails()).header.stamp, messages.stamp);
  simulator.step();
  expectAsNew(messages);
}

// The topology is what clients may rely on unless they ask for less.
TEST(MeshMarker, HasTheFineTrianglesUnlessLessIsAskedFor) {
  curtain::Scene scene = shippedScene("curtain");
  for (curtain::WindParams& wind : scene.wind)
    wind.unsteadiness = 0.0;  // what folds need depends on how they are blown about
  curtain::Simulator simulator(scene);
  for (int frame = 0; frame < 30; ++frame) simulator.step();
  Messages messages(simulator);
  const auto full = messages.buildMesh();
  const curtain::FineMesh& mesh = messages.geometry.fineMesh();
  const auto& triangles = simulator.fineMeshTopology().triangles;
  ASSERT_EQ(full->points.size(), 3 * triangles.size());
  for (std::size_t i = 0; i < full->points.size(); ++i) {
    const curtain::Vec3& node = mesh.positions[triangles[i / 3][i % 3]];
    EXPECT_EQ(curtain::Vec3(full->points[i].x, full->points[i].y, full->points[i].z), node);
  }

  const std::uint64_t picture = messages.mesh.update(messages.detail);
  messages.detail.viewer = curtain::Vec3(0.3, -16.0, 1.2);
  messages.detail.viewer_tolerance = 1e-3;
  EXPECT_NE(messages.mesh.update(messages.detail), picture) << "another eye, another picture";
  const auto reduced = messages.buildMesh();
  EXPECT_LT(reduced->points.size(), full->points.size() / 3);
  EXPECT_EQ(reduced->colors.size(), reduced->points.size());
  messages.detail.viewer->y() = -20.0;
  EXPECT_LT(messages.buildMesh()->points.size(), reduced->points.size());
  EXPECT_EQ(messages.mesh.update(messages.detail), messages.mesh.update(messages.detail));
}

// A sheet over two boxes of one link that is turned anyhow: the link feels the sheet's weight, in its own axes and
// about its own origin.
TEST(WrenchMessages, AreInTheFrameOfTheLink) {
  curtain::Scene scene;
  scene.cloth.rows = 12;
  scene.cloth.columns = 10;
  scene.cloth.height = scene.cloth.width = 0.6;
  scene.hang.from = Vec3(-0.3, 0.3, 0.02);
  scene.hang.to = Vec3(0.3, 0.3, 0.02);
  scene.hang.tilt = 0.5 * curtain::kPi;
  scene.pins.kind = curtain::PinKind::kNone;
  scene.air.inside = scene.air.border = scene.air.corner = 0.5;
  curtain::Pose link;  // in the world
  link.position = Vec3(0.4, -0.3, -0.7);
  link.orientation = Eigen::AngleAxisd(2.1, Vec3(0.3, -0.5, 0.8).normalized());
  std::vector<Vec3> middles = {Vec3(-0.2, 0.0, -0.1), Vec3(0.2, 0.0, -0.1), Vec3(5.0, 0.0, 0.0)};
  for (std::size_t n = 0; n < middles.size(); ++n) {
    curtain::ObstacleParams box;
    box.name = "box " + std::to_string(n);
    box.shape = curtain::ShapeKind::kBox;
    box.size = Vec3(0.4, 2.0, 0.2);
    box.pose.orientation = link.orientation.conjugate();
    box.pose.position = box.pose.orientation * (middles[n] - link.position);
    scene.obstacles.push_back(box);
  }
  curtain::Simulator simulator(scene);
  for (int n = 0; n < 3; ++n)
    simulator.setObstaclePose(n, transformPose(link, scene.obstacles[static_cast<std::size_t>(n)].pose), true);
  simulator.setObstaclePresent(2, false);
  for (int frame = 0; frame < 240; ++frame) simulator.step();
  Vec3 centre = Vec3::Zero();
  double mass = 0.0;
  for (int i = 0; i < simulator.rows(); ++i) {
    for (int j = 0; j < simulator.columns(); ++j) {
      mass += simulator.mass({i, j});
      centre += simulator.mass({i, j}) * simulator.position({i, j});
    }
  }
  const Vec3 weight(0.0, 0.0, -9.81 * mass);
  const Vec3 torque = (centre / mass - link.position).cross(weight);
  WrenchMessages messages("hand", {0, 1, 2});
  const auto message = messages.build(simulator, ros::Time(3.0));
  EXPECT_EQ(message->header.frame_id, "hand");
  EXPECT_EQ(message->header.stamp, ros::Time(3.0));
  const double off = (toVec3(message->wrench.force) - link.orientation.conjugate() * weight).norm() / weight.norm();
  curtain_test::keepFigure("wrench of a sheet on a link, off by", off);
  EXPECT_LT(off, 1e-3);
  EXPECT_LT((toVec3(message->wrench.torque) - link.orientation.conjugate() * torque).norm(), 1e-3 * weight.norm());
  simulator.setObstaclePresent(0, false);
  simulator.setObstaclePresent(1, false);
  EXPECT_EQ(toVec3(messages.build(simulator, ros::Time(4.0))->wrench.force), Vec3::Zero())
      << "absent ones feel nothing";
}

TEST(ContactMessages, HaveThePointsThatAreAskedFor) {
  curtain::Scene scene = smallScene();
  scene.obstacles.insert(scene.obstacles.begin(), curtain_test::ballAt({5.0, 0.0, 0.0}, 0.1));
  scene.obstacles[0].name = "absent";
  curtain::Pose pushed;
  pushed.position = Vec3(0.3, 0.05, 1.5);
  scene.obstacles[1].motion = {{0.0, scene.obstacles[1].pose}, {1.0, pushed}};
  curtain::Simulator simulator(scene);
  simulator.setObstaclePresent(0, false);
  for (int frame = 0; frame < 60; ++frame) simulator.step();
  NodeParams params;
  EXPECT_TRUE(ContactMessages(params).build(simulator, ros::Time(1.0))->points.empty());
  params.contact_points = true;
  const auto message = ContactMessages(params).build(simulator, ros::Time(1.0));
  ASSERT_EQ(message->obstacles.size(), 1U);
  ASSERT_GT(message->points.size(), 0U);
  EXPECT_EQ(message->points.size(), message->obstacles[0].contacts);
  for (const auto& point : message->points) {
    EXPECT_EQ(point.obstacle, 0U) << "of those in the message";
    EXPECT_GT(point.normal_force, 0.0);
    EXPECT_LT(point.normal.y, 0.0) << "out of the ball";
  }
  GeometryCache geometry(simulator);
  for (const bool asked : {false, true}) {
    DetailMarkers details("world", geometry, asked);
    details.update();
    const auto array = details.build(ros::Time(1.0));
    const auto arrows = std::find_if(array->markers.begin(), array->markers.end(),
                                     [](const auto& marker) { return marker.ns == "contacts"; });
    ASSERT_NE(arrows, array->markers.end());
    EXPECT_EQ(arrows->action, asked ? visualization_msgs::Marker::ADD : visualization_msgs::Marker::DELETE);
    EXPECT_EQ(arrows->points.size(), asked ? 6 * message->points.size() : 0U);
  }
}

// A ball that can't go through a sheet pinned above and below: ~contacts and ~markers have it where it waits.
TEST(ContactMessages, AndMarkersHaveAnObstacleWhereItWaits) {
  curtain::Scene scene = curtain_test::flatScene(16, 16, 0.8, 0.8);
  scene.pins.kind = curtain::PinKind::kList;
  for (int j = 0; j < 16; ++j) {
    scene.pins.nodes.push_back({0, j});
    scene.pins.nodes.push_back({15, j});
  }
  scene.obstacles.push_back(curtain_test::ballAt({0.4, -0.16, 0.42}, 0.15));
  curtain::Simulator simulator(scene);
  curtain::Pose goal = scene.obstacles[0].pose;
  for (int frame = 0; frame < 30; ++frame) {
    goal.position.y() += 0.007;
    simulator.setObstaclePose(0, goal);
    simulator.step();
  }
  const auto contacts = ContactMessages(NodeParams()).build(simulator, ros::Time(1.0));
  const curtain_sim::ObstacleContact& ball = contacts->obstacles.at(0);
  const Vec3 middle(ball.origin.x, ball.origin.y, ball.origin.z);
  EXPECT_GT(ball.lag, 0.1);
  EXPECT_NEAR(ball.lag, goal.position.y() - middle.y(), 1e-12);
  std::vector<Vec3> nodes;
  simulator.copyPositions(nodes);
  double nearest = 1.0;
  for (const Vec3& node : nodes) nearest = std::min(nearest, (node - middle).norm());
  EXPECT_GE(nearest, 0.15);
  Messages messages(simulator);
  const auto array = messages.buildDetails();
  const auto drawn = std::find_if(array->markers.begin(), array->markers.end(),
                                  [](const auto& marker) { return marker.ns == "obstacles"; });
  ASSERT_NE(drawn, array->markers.end());
  EXPECT_EQ(drawn->pose.position.y, middle.y());
}

TEST(DetailMarkers, ANumberForEveryPicture) {
  curtain::Simulator simulator(smallScene());
  Messages messages(simulator);
  const std::uint64_t first = messages.details.update();
  EXPECT_EQ(messages.details.update(), first);
  simulator.setWind(fan(1.0));
  const std::uint64_t windy = messages.details.update();
  EXPECT_NE(windy, first);
  simulator.setWind(fan(2.0));
  EXPECT_EQ(messages.details.update(), windy) << "the cone is the same";
  simulator.step();
  EXPECT_NE(messages.details.update(), windy);
}

// One that is free again is filled again; while somebody holds it a copy takes its place.
TEST(DetailMarkers, ObstaclesHaveTheirColorAndMayBeInvisible) {
  curtain::Scene scene = smallScene();
  scene.obstacles.push_back(curtain_test::ballAt({0.3, -0.4, 1.5}, 0.1));
  scene.obstacles[1].name = "hidden";
  scene.obstacles[0].color = {1.0, 0.5, 0.0};
  scene.obstacles[1].visible = false;
  const curtain::Simulator simulator(scene);
  Messages messages(simulator);
  const auto array = messages.buildDetails();
  const auto of = [&](int id) {
    return *std::find_if(array->markers.begin(), array->markers.end(),
                         [&](const auto& marker) { return marker.ns == "obstacles" && marker.id == id; });
  };
  EXPECT_EQ(of(0).action, visualization_msgs::Marker::ADD);
  EXPECT_EQ(of(1).action, visualization_msgs::Marker::DELETE);
  ASSERT_EQ(of(0).colors.size(), of(0).points.size());
  for (const auto& colour : of(0).colors) {
    EXPECT_GT(colour.r, colour.g);
    EXPECT_GT(colour.g, 0.0F);
    EXPECT_EQ(colour.b, 0.0F);
  }
}

TEST(ReusedMessage, IsCopiedOnlyWhileItIsHeld) {
  ReusedMessage<int> message(7);
  const auto held = message.edit();
  const auto copy = message.edit();
  EXPECT_NE(copy, held);
  EXPECT_EQ(*copy, 7);
  *copy = 8;
  EXPECT_EQ(*held, 7);
  const int* const free = message.edit().get();
  EXPECT_NE(free, copy.get());
  EXPECT_EQ(message.edit().get(), free);
  EXPECT_EQ(*message.edit(), 8);
}

}  // namespace
}  // namespace curtain_ros
