// SPDX-License-Identifier: BSD-3-Clause
//
// A URDF becomes obstacles: every kind of geometry with its origin and scale, the links that are asked for; and what is
// wrong with it is said in words.
#include "ros/parameters/robot.h"

#include <console_bridge/console.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "testing.h"

namespace curtain_ros {
namespace {

using curtain::ObstacleParams;
using curtain::ShapeKind;
using curtain::Vec3;

std::string waiter() {
  std::ifstream file(std::string(CURTAIN_SOURCE_DIR) + "/test/ros/robot.urdf");
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string robotWith(const std::string& links) { return "<robot name=\"r\">" + links + "</robot>"; }

std::string link(const std::string& geometry) {
  return robotWith("<link name=\"arm\"><collision><geometry>" + geometry + "</geometry></collision></link>");
}

std::vector<std::string> namesOf(const RobotReading& reading) {
  std::vector<std::string> names;
  for (const ObstacleParams& obstacle : reading.obstacles) names.push_back(obstacle.name);
  return names;
}

RobotReading readLinks(const std::vector<std::string>& links) {
  RobotParams params;
  params.links = links;
  return readRobot(params, waiter());
}

using Names = std::vector<std::string>;

TEST(Robot, EveryGeometryIsAnObstacle) {
  const RobotReading reading = readRobot({}, waiter());
  ASSERT_TRUE(reading.problems.empty()) << curtain::describe(reading.problems);
  ASSERT_EQ(namesOf(reading), (Names{"base", "cube", "finger_1", "slider", "tray/0", "tray/1"})) << "by name";
  const ObstacleParams& base = reading.obstacles[0];
  EXPECT_EQ(base.shape, ShapeKind::kCylinder);
  EXPECT_EQ(base.radius, 0.2);
  EXPECT_EQ(base.length, 0.1);
  EXPECT_EQ(base.pose.position, Vec3(0.0, 0.0, 0.05));
  EXPECT_EQ(base.frame, "base");
  EXPECT_EQ(base.padding, 0.0);
  EXPECT_TRUE(std::isnan(base.friction)) << "contact.friction";
  EXPECT_TRUE(base.visible);
  const ObstacleParams& cube = reading.obstacles[1];
  EXPECT_EQ(cube.shape, ShapeKind::kMesh);
  EXPECT_EQ(cube.mesh, "package://curtain_sim/test/meshes/cube_binary.stl");
  EXPECT_EQ(cube.scale, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(reading.obstacles[3].shape, ShapeKind::kSphere);
  EXPECT_EQ(reading.obstacles[3].radius, 0.1);
  const ObstacleParams& plate = reading.obstacles[4];
  EXPECT_EQ(plate.shape, ShapeKind::kBox);
  EXPECT_EQ(plate.size, Vec3(0.48, 0.96, 0.02));
  EXPECT_EQ(plate.pose.position, Vec3(-0.2107, 0.05, -0.1151));
  EXPECT_EQ(plate.frame, "tray");
  const Eigen::Quaterniond pitched(Eigen::AngleAxisd(-0.5, Vec3::UnitY()));
  EXPECT_LT(plate.pose.orientation.angularDistance(pitched), 1e-15);
  EXPECT_EQ(reading.obstacles[5].frame, "tray");
}

TEST(Robot, ParametersGoToEveryObstacle) {
  RobotParams params;
  params.padding = 0.01;
  params.friction = 0.7;
  params.tf_prefix = "left";
  params.visible = false;
  const RobotReading reading = readRobot(params, waiter());
  ASSERT_EQ(reading.obstacles.size(), 6U);
  for (const ObstacleParams& obstacle : reading.obstacles) {
    EXPECT_EQ(obstacle.padding, 0.01);
    EXPECT_EQ(obstacle.friction, 0.7);
    EXPECT_EQ(obstacle.frame.rfind("left/", 0), 0U) << obstacle.frame;
    EXPECT_NE(obstacle.name.rfind("left/", 0), 0U) << obstacle.name;
    EXPECT_FALSE(obstacle.visible);
  }
}

TEST(Robot, LinksAreNamedOrMatchedAsAWhole) {
  EXPECT_EQ(namesOf(readLinks({"slider", "base"})), (Names{"base", "slider"}));
  EXPECT_EQ(namesOf(readLinks({"finger_[0-9]", "tr.*"})), (Names{"finger_1", "tray/0", "tray/1"}));
  EXPECT_EQ(namesOf(readLinks({"slider", "sl.*"})), (Names{"slider"})) << "once";
  EXPECT_EQ(namesOf(readLinks({".*"})).size(), 6U);
  const RobotReading part = readLinks({"slide"});
  ASSERT_EQ(part.problems.size(), 1U) << "a part of a name is none";
  EXPECT_EQ(part.problems[0].key, "links");
  EXPECT_EQ(part.problems[0].text, "'slide' names no link of 'waiter'");
  EXPECT_TRUE(readRobot({}, robotWith("<link name=\"a+b\"><collision><geometry><sphere radius=\"1\"/></geometry>"
                                      "</collision></link>"))
                  .problems.empty());
  RobotParams plus;
  plus.links = {"a+b"};
  EXPECT_EQ(
      namesOf(readRobot(plus, robotWith("<link name=\"a+b\"><collision><geometry><sphere radius=\"1\"/></geometry>"
                                        "</collision></link>"))),
      (Names{"a+b"}))
      << "a name comes before an expression";
}

TEST(Robot, EverythingWrongWithLinksIsNamedAtOnce) {
  const RobotReading reading = readLinks({"slider", "leg_.*", "camera", "arm["});
  ASSERT_EQ(reading.problems.size(), 3U);
  EXPECT_EQ(reading.problems[0].text, "'leg_.*' names no link of 'waiter'");
  EXPECT_EQ(reading.problems[1].text, "'camera' names no link with collision geometry");
  EXPECT_EQ(reading.problems[2].text.rfind("'arm[' is no link and no regular expression: ", 0), 0U)
      << reading.problems[2].text;
  for (const curtain::Problem& problem : reading.problems) EXPECT_EQ(problem.key, "links");
}

std::string onlyProblem(const std::string& urdf) {
  const RobotReading reading = readRobot({}, urdf);
  EXPECT_EQ(reading.problems.size(), 1U) << curtain::describe(reading.problems);
  if (reading.problems.empty()) return "";
  EXPECT_EQ(reading.problems[0].key, "");
  return reading.problems[0].text;
}

TEST(Robot, ADescriptionThatIsNoneSaysWhy) {
  EXPECT_EQ(onlyProblem("").rfind("is not a valid URDF: ", 0), 0U);
  const std::string cut =
      onlyProblem("<robot name=\"r\"><link");  // in the words of TinyXML, or from urdfdom 4 on TinyXML 2
  EXPECT_TRUE(cut.find("Failed to read") != std::string::npos || cut.find("XML_ERROR_PARSING") != std::string::npos)
      << cut;
  EXPECT_NE(onlyProblem("<sdf/>").find("Could not find the 'robot' element"), std::string::npos);
  EXPECT_NE(onlyProblem(robotWith("")).find("No link elements"), std::string::npos);
  EXPECT_NE(onlyProblem(link("<cone/>")).find("Unknown geometry type 'cone'"), std::string::npos);
  EXPECT_NE(onlyProblem(link("<box size=\"1 2\"/>")).find("3 expected"), std::string::npos);
  EXPECT_EQ(onlyProblem(robotWith("<link name=\"a\"/><link name=\"b\"/>"
                                  "<joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>")),
            "no link of 'r' has collision geometry");
}

// Many robots have capsules, which URDF has not: one message names the links and says what to do.
TEST(Robot, GeometryThatUrdfHasNotIsNamedOnceWithItsLinks) {
  const auto part = [](const std::string& name, const std::string& kind, const std::string& geometry) {
    return "<link name=\"" + name + "\"><" + kind + "><geometry>" + geometry + "</geometry></" + kind + "></link>";
  };
  const std::string capsule = "<capsule radius=\"0.1\" length=\"0.5\"/>";
  const std::string joints =
      "<joint name=\"j\" type=\"fixed\"><parent link=\"hip\"/><child link=\"knee\"/></joint>"
      "<joint name=\"k\" type=\"fixed\"><parent link=\"hip\"/><child link=\"toe\"/></joint>"
      "<joint name=\"l\" type=\"fixed\"><parent link=\"hip\"/><child link=\"eye\"/></joint>";
  EXPECT_EQ(
      onlyProblem(robotWith(part("hip", "collision", capsule) + part("knee", "collision", capsule) +
                            part("toe", "collision", "<sphere radius=\"1\"/>") + part("eye", "visual", capsule) +
                            joints)),
      "is not a valid URDF: Unknown geometry type 'capsule' of the links 'hip', 'knee', 'eye': URDF has box, cylinder, "
      "sphere and mesh; a capsule is a cylinder and two spheres, each a <collision> of its own, or a mesh");
  EXPECT_EQ(
      onlyProblem(link("<cone/>")),
      "is not a valid URDF: Unknown geometry type 'cone' of the link 'arm': URDF has box, cylinder, sphere and mesh");
  const std::string both =
      onlyProblem(robotWith(part("hip", "collision", capsule) + part("knee", "collision", "<cone/>") +
                            part("toe", "collision", "<sphere/>") + joints));
  for (const char* what : {"'capsule' of the link 'hip'", "'cone' of the link 'knee'", "for Link [toe]"})
    EXPECT_NE(both.find(what), std::string::npos) << both;
}

TEST(Robot, SizesThatNoObstacleCanHaveAreProblems) {
  EXPECT_EQ(onlyProblem(link("<sphere radius=\"-1\"/>")).rfind("collision geometry 'arm': radius: must be", 0), 0U);
  EXPECT_EQ(onlyProblem(link("<box size=\"1 0 1\"/>")).rfind("collision geometry 'arm': size[1]: must be", 0), 0U);
  EXPECT_EQ(onlyProblem(link("<mesh filename=\"m.stl\" scale=\"1 0 1\"/>")).rfind("collision geometry 'arm': scale", 0),
            0U);
}

// A mesh that can't be had is told of with its link; relative paths, which many robots have, are one message.
TEST(Robot, MeshesThatCantBeHadAreNamedWithTheirLinks) {
  const auto mesh = [](const std::string& name, const std::string& url) {
    return "<link name=\"" + name + "\"><collision><geometry><mesh filename=\"" + url +
           "\"/></geometry></collision></link>";
  };
  const auto joint = [](const std::string& child) {
    return "<joint name=\"to_" + child + "\" type=\"fixed\"><parent link=\"base\"/><child link=\"" + child +
           "\"/></joint>";
  };
  const std::string cube = std::string(CURTAIN_SOURCE_DIR) + "/test/meshes/cube_binary.stl";
  const RobotReading robot =
      readRobot({}, robotWith(mesh("base", "meshes/base.stl") + mesh("arm", "../arm.stl") +
                              mesh("hand", "file://localhost" + cube) + mesh("thumb", "file:///nowhere/thumb.stl") +
                              mesh("nail", "http://a/nail.stl") + mesh("ring", cube) + joint("arm") + joint("hand") +
                              joint("thumb") + joint("nail") + joint("ring")));
  ASSERT_TRUE(robot.problems.empty()) << curtain::describe(robot.problems);
  EXPECT_EQ(robot.links, (Names{"arm", "base", "hand", "nail", "ring", "thumb"}));
  const std::vector<std::string> problems = meshProblems(robot);
  ASSERT_EQ(problems.size(), 3U);
  EXPECT_EQ(problems[0].rfind("the link 'nail': obstacle 'nail': mesh 'http://a/nail.stl' cannot be resolved", 0), 0U)
      << problems[0];
  EXPECT_EQ(problems[1], "the link 'thumb': obstacle 'thumb': mesh '/nowhere/thumb.stl' does not exist");
  EXPECT_EQ(
      problems[2],
      "meshes of the links 'arm', 'base' must be package://PACKAGE/PATH, file:///PATH or a whole path, are relative "
      "paths, as '../arm.stl': a URDF on the parameter server has no folder");
  const RobotReading flat = readRobot({}, link("<mesh filename=\"/nowhere/m.stl\" scale=\"1 0 1\"/>"));
  EXPECT_EQ(flat.problems.size(), 1U);
  EXPECT_TRUE(meshProblems(flat).empty()) << "told already";
}

// Only while it reads a URDF errors go elsewhere than to the log.
TEST(Robot, TheLogHasItsErrorsBack) {
  console_bridge::OutputHandler* const before = console_bridge::getOutputHandler();
  readRobot({}, "<robot");
  EXPECT_EQ(console_bridge::getOutputHandler(), before);
}

}  // namespace
}  // namespace curtain_ros
