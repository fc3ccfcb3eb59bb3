// SPDX-License-Identifier: BSD-3-Clause
//
// Messages become engine structs in the world frame, or problems that name the field.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "curtain_sim/simulator.h"
#include "ros/inputs/handles.h"
#include "ros/inputs/read_messages.h"
#include "ros/outputs/state_messages.h"

namespace curtain_ros {
namespace {

using curtain_sim::DragForce;
using curtain_sim::WindSource;

const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInf = std::numeric_limits<double>::infinity();

WindSource goodWind() {
  WindSource wind;
  wind.id = "fan";
  wind.pose.orientation.w = 1.0;
  wind.radius = 0.5;
  wind.pressure = 3.0;
  return wind;
}

DragForce goodDrag() {
  DragForce drag;
  drag.id = "hand";
  drag.row = 9;
  drag.column = 7;
  drag.force.y = 0.5;
  return drag;
}

curtain::ClothParams grid() {
  curtain::ClothParams cloth;
  cloth.rows = 10;
  cloth.columns = 8;
  return cloth;
}

// A frame one metre along x and turned a quarter about z.
curtain::Pose turnedFrame() {
  curtain::Pose pose;
  pose.position = curtain::Vec3(1.0, 0.0, 0.0);
  pose.orientation = Eigen::AngleAxisd(M_PI / 2, curtain::Vec3::UnitZ());
  return pose;
}

curtain::Simulator& simulator() {
  static curtain::Simulator instance([] {
    curtain::Scene scene;
    scene.cloth.rows = grid().rows;
    scene.cloth.columns = grid().columns;
    return scene;
  }());
  return instance;
}

// Of all who judge a message: the conversion knows its fields, the simulator what it can compute.
std::string windProblems(const WindSource& message) {
  curtain::WindParams wind;
  std::vector<curtain::Problem> problems = toWind(message, curtain::Pose(), 2.0, wind);
  if (problems.empty()) problems = simulator().setWind(wind);
  return curtain::describe(problems);
}

std::string dragProblems(const DragForce& message) {
  curtain::DragParams drag;
  std::vector<curtain::Problem> problems = toDrag(message, curtain::Pose(), 2.0, grid(), drag);
  if (problems.empty()) problems = simulator().setDrag(drag);
  return curtain::describe(problems);
}

TEST(Conversions, WindIsTurnedIntoTheWorld) {
  WindSource message = goodWind();
  message.pose.position.x = 2.0;
  message.lifetime = 3.0;
  message.unsteadiness = 0.7;
  message.shadow = true;
  message.profile = WindSource::RING_JET;
  curtain::WindParams wind;
  wind.porosity_weight = 0.25;
  ASSERT_EQ(curtain::describe(toWind(message, turnedFrame(), 2.0, wind)), "");
  EXPECT_TRUE(wind.position.isApprox(curtain::Vec3(1.0, 2.0, 0.0)));
  EXPECT_TRUE(wind.direction.isApprox(curtain::Vec3::UnitY()));
  EXPECT_EQ(wind.start, 2.0);
  EXPECT_EQ(wind.end, 5.0);
  EXPECT_EQ(wind.pressure, 3.0);
  EXPECT_EQ(wind.unsteadiness, 0.7);
  EXPECT_TRUE(wind.shadow);
  EXPECT_EQ(wind.profile, curtain::WindProfile::kRingJet);
  EXPECT_EQ(wind.correlation_time, curtain::WindParams().correlation_time) << "0 is the default";
  EXPECT_EQ(wind.porosity_weight, 0.25) << "what a message does not name is kept";
}

TEST(Conversions, LifetimeZeroIsForEver) {
  curtain::WindParams wind;
  toWind(goodWind(), curtain::Pose(), 2.0, wind);
  EXPECT_EQ(wind.end, kInf);
}

TEST(Conversions, OrientationsAreBroughtToUnitLength) {
  WindSource message = goodWind();
  message.pose.orientation.w = 0.1;
  message.pose.orientation.z = 0.1;
  curtain::WindParams wind;
  ASSERT_EQ(curtain::describe(toWind(message, curtain::Pose(), 0.0, wind)), "");
  EXPECT_TRUE(wind.direction.isApprox(curtain::Vec3::UnitY()));
}

TEST(Conversions, BadWindsAreNamed) {
  const auto expect = [](const std::string& field, void (*spoil)(WindSource&)) {
    WindSource message = goodWind();
    spoil(message);
    EXPECT_NE(windProblems(message).find(field), std::string::npos) << field << ": " << windProblems(message);
  };
  expect("pose.position", [](WindSource& m) { m.pose.position.z = kNan; });
  expect("pose.orientation", [](WindSource& m) { m.pose.orientation.w = 0.0; });
  expect("pose.orientation", [](WindSource& m) { m.pose.orientation.x = kInf; });
  expect("radius", [](WindSource& m) { m.radius = 0.0; });
  expect("radius", [](WindSource& m) { m.radius = kNan; });
  expect("half_angle", [](WindSource& m) { m.half_angle = -0.1; });
  expect("half_angle", [](WindSource& m) { m.half_angle = 1.6; });
  expect("pressure", [](WindSource& m) { m.pressure = kInf; });
  expect("pressure", [](WindSource& m) { m.pressure = -1.0; });
  expect("unsteadiness", [](WindSource& m) { m.unsteadiness = -1.0; });
  expect("correlation_time", [](WindSource& m) { m.correlation_time = -1.0; });
  expect("correlation_time", [](WindSource& m) { m.correlation_time = 1e-7; });
  expect("correlation_time", [](WindSource& m) { m.correlation_time = kNan; });
  expect("lifetime", [](WindSource& m) { m.lifetime = kNan; });
  expect("profile", [](WindSource& m) { m.profile = 2; });
  // Finite, but nothing that a cloth could be held against.
  expect("pose.position", [](WindSource& m) { m.pose.position.x = -1e300; });
  expect("pose.orientation", [](WindSource& m) { m.pose.orientation.x = 1e200; });
  expect("radius", [](WindSource& m) { m.radius = 1e300; });
  expect("pressure", [](WindSource& m) { m.pressure = 1.1e9; });
  expect("unsteadiness", [](WindSource& m) { m.unsteadiness = 1.1e9; });
  expect("correlation_time", [](WindSource& m) { m.correlation_time = 1.1e6; });
  expect("lifetime", [](WindSource& m) { m.lifetime = 1e300; });
}

TEST(Conversions, TheStrongestAreTaken) {
  WindSource wind = goodWind();
  wind.pressure = wind.unsteadiness = 1e9;
  wind.correlation_time = 1e6;
  wind.lifetime = wind.radius = wind.pose.position.x = 1e9;
  EXPECT_EQ(windProblems(wind), "");
  DragForce drag = goodDrag();
  drag.force.x = -1e6;
  drag.lifetime = drag.radius = 1e9;
  EXPECT_EQ(dragProblems(drag), "");
  drag.mode = DragForce::SPRING;
  drag.stiffness = 1e6;
  drag.target.z = -1e9;
  EXPECT_EQ(dragProblems(drag), "");
}

TEST(Conversions, NamesAreShort) {
  WindSource wind = goodWind();
  wind.id = wind.header.frame_id = std::string(255, 'x');
  EXPECT_TRUE(checkHead(wind).empty());
  wind.id += 'x';
  EXPECT_EQ(checkHead(wind).size(), 1U);
  wind.header.frame_id += std::string(10000000, '\n');
  const std::string problems = curtain::describe(checkHead(wind));
  EXPECT_NE(problems.find("id"), std::string::npos);
  EXPECT_NE(problems.find("header.frame_id"), std::string::npos);
  EXPECT_LT(problems.size(), 300U);
  wind.action = WindSource::DELETE;
  EXPECT_EQ(checkHead(wind).size(), 2U);
}

// What a problem says of an id stands on one line of the log.
TEST(Conversions, NamesAreShownOnALine) {
  EXPECT_EQ(forLog("fan"), "fan");
  EXPECT_EQ(forLog("a\nb\x1b[31m\x7f"), "a?b?[31m?");
  EXPECT_EQ(forLog(std::string(100, 'x'), 10), "xxxxxxxxxx… (100 bytes)");
}

TEST(Conversions, HeadsAreChecked) {
  WindSource wind = goodWind();
  EXPECT_TRUE(checkHead(wind).empty());
  wind.action = 1;
  EXPECT_EQ(checkHead(wind).at(0).key, "action");
  wind.action = WindSource::DELETE;
  wind.id = "";
  EXPECT_EQ(checkHead(wind).at(0).key, "id");
  wind.action = WindSource::DELETEALL;
  EXPECT_TRUE(checkHead(wind).empty());
  DragForce drag = goodDrag();
  drag.id = "";
  EXPECT_EQ(checkHead(drag).at(0).key, "id");
}

TEST(Conversions, DragByNodeIsAForceInTheWorld) {
  curtain::DragParams drag;
  DragForce message = goodDrag();
  message.target.x = kNan;  // not read in mode FORCE
  ASSERT_EQ(curtain::describe(toDrag(message, turnedFrame(), 2.0, grid(), drag)), "");
  ASSERT_TRUE(drag.node.has_value());
  EXPECT_EQ(drag.node->row, 9);
  EXPECT_EQ(drag.node->column, 7);
  EXPECT_FALSE(drag.point.has_value());
  EXPECT_FALSE(drag.target.has_value());
  EXPECT_TRUE(drag.force.isApprox(curtain::Vec3(-0.5, 0.0, 0.0)));
}

TEST(Conversions, DragByPointIsASpring) {
  DragForce message = goodDrag();
  message.row = message.column = -1;
  message.mode = DragForce::SPRING;
  message.point.x = 1.0;
  message.target.x = 2.0;
  curtain::DragParams drag;
  ASSERT_EQ(curtain::describe(toDrag(message, turnedFrame(), 2.0, grid(), drag)), "");
  ASSERT_TRUE(drag.point && drag.target && !drag.node);
  EXPECT_TRUE(drag.point->isApprox(curtain::Vec3(1.0, 1.0, 0.0)));
  EXPECT_TRUE(drag.target->isApprox(curtain::Vec3(1.0, 2.0, 0.0)));
  EXPECT_EQ(drag.force, curtain::Vec3::Zero());
  EXPECT_EQ(drag.stiffness, curtain::DragParams().stiffness) << "0 is the default";
}

TEST(Conversions, BadDragsAreNamed) {
  const auto expect = [](const std::string& field, void (*spoil)(DragForce&)) {
    DragForce message = goodDrag();
    spoil(message);
    EXPECT_NE(dragProblems(message).find(field), std::string::npos) << field << ": " << dragProblems(message);
  };
  expect("row, column", [](DragForce& m) { m.row = 10; });
  expect("row, column", [](DragForce& m) { m.column = 8; });
  expect("row, column", [](DragForce& m) { m.row = -1; });
  expect("row, column", [](DragForce& m) { m.column = -2; });
  expect("mode", [](DragForce& m) { m.mode = 2; });
  expect("force", [](DragForce& m) { m.force.x = kNan; });
  expect("point", [](DragForce& m) {
    m.row = m.column = -1;
    m.point.y = kInf;
  });
  expect("target", [](DragForce& m) {
    m.mode = DragForce::SPRING;
    m.target.y = kNan;
  });
  expect("stiffness", [](DragForce& m) {
    m.mode = DragForce::SPRING;
    m.stiffness = -1.0;
  });
  expect("radius", [](DragForce& m) { m.radius = -1.0; });
  expect("lifetime", [](DragForce& m) { m.lifetime = -1.0; });
}

TEST(Conversions, PointsAreFlatXyz) {
  std::vector<float> flat;
  flatten({{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}, flat);
  EXPECT_EQ(flat, (std::vector<float>{1, 2, 3, 4, 5, 6}));
}

// Second-layer nodes only: fine columns that are no multiple of the folds.
TEST(Conversions, FoldsLeaveTheFirstLayerOut) {
  curtain::FineMeshTopology topology;
  topology.rows = 2;
  topology.columns = 4;
  topology.folds = 3;
  curtain::FineMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i, 0.0, 0.0);
  std::vector<float> flat;
  flattenFolds(topology, mesh, flat);
  EXPECT_EQ(flat, (std::vector<float>{1, 0, 0, 2, 0, 0, 5, 0, 0, 6, 0, 0}));
}

// Five handles, both corners among them; a ring has no corners; a narrow cloth has a handle per column.
TEST(Handles, AreSpreadOverTheHem) {
  curtain::ClothParams cloth;
  cloth.columns = 41;
  EXPECT_EQ(handleColumns(cloth), (std::vector<int>{0, 10, 20, 30, 40}));
  cloth.columns = 40;
  cloth.closed = true;
  EXPECT_EQ(handleColumns(cloth), (std::vector<int>{0, 8, 16, 24, 32}));
  cloth.columns = 3;
  cloth.closed = false;
  EXPECT_EQ(handleColumns(cloth), (std::vector<int>{0, 1, 2}));
  cloth.columns = 2;
  EXPECT_EQ(handleColumns(cloth), (std::vector<int>{0, 1}));
}

}  // namespace
}  // namespace curtain_ros
