// SPDX-License-Identifier: BSD-3-Clause
//
// The node's parameters are read strictly: wrong types, text for numbers, unknown keys and values out of range are
// all named at once; a parameter tree and a scene file of the same text give the same scene.
#include "ros/parameters/parameters.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <set>

#include "curtain_sim/scene_yaml.h"

namespace curtain_ros {
namespace {

using XmlRpc::XmlRpcValue;

// XmlRpc's constructors are explicit enough to need help with literals.
XmlRpcValue value(int number) { return XmlRpcValue(number); }
XmlRpcValue value(double number) { return XmlRpcValue(number); }
XmlRpcValue value(const char* text) { return XmlRpcValue(std::string(text)); }
XmlRpcValue flag(bool on) { return XmlRpcValue(on); }

XmlRpcValue smallSceneParameters() {
  XmlRpcValue scene;
  scene["cloth"]["rows"] = value(10);
  scene["cloth"]["columns"] = value(8);
  return scene;
}

ParameterReading readWith(const std::string& key, const XmlRpcValue& content) {
  XmlRpcValue tree;
  tree["scene"] = smallSceneParameters();
  tree[key] = content;
  return readParameters(tree, "/stage/curtain");
}

ParameterReading readScene(const XmlRpcValue& scene) { return readWith("scene", scene); }

::testing::AssertionResult names(const std::vector<std::string>& lines, const std::string& what) {
  for (const std::string& line : lines) {
    if (line.find(what) != std::string::npos) return ::testing::AssertionSuccess();
  }
  auto result = ::testing::AssertionFailure() << "nothing names '" << what << "' among:";
  for (const std::string& line : lines) result << "\n  " << line;
  return result;
}

// Types and bits come through: a number with a fraction is no integer, and text no number that is not wholly one.
TEST(Parameters, KeepTheirTypesAndBits) {
  for (const double number : {0.1 + 0.2, 1.0, 1e-9}) {
    EXPECT_EQ(readWith("obstacle_timeout", value(number)).node.obstacle_timeout, number);
  }
  EXPECT_EQ(readWith("obstacle_timeout", value("1.0")).node.obstacle_timeout, 1.0);
  EXPECT_TRUE(names(readWith("obstacle_timeout", value("1.0 s")).problems, "must be a number in"));
  EXPECT_TRUE(
      names(readWith("max_catch_up", value(4.0)).problems, "max_catch_up: must be an integer in [1, 1000], is 4.0"));
  EXPECT_TRUE(names(readWith("obstacle_timeout", value(std::numeric_limits<double>::infinity())).problems, "is .inf"));
  EXPECT_TRUE(readWith("state_folds", flag(true)).node.state_folds);
  EXPECT_EQ(readWith("world_frame", value("true")).node.world_frame, "true");
  EXPECT_EQ(readWith("world_frame", value("1e3")).node.world_frame, "1e3");
}

// rosparam takes 3e-06, as Python prints it, for text.
TEST(Parameters, TextThatIsWhollyANumberIsThatNumber) {
  EXPECT_EQ(readWith("obstacle_timeout", value("3e-06")).node.obstacle_timeout, 3e-6);
  EXPECT_EQ(readWith("max_catch_up", value("7")).node.max_catch_up, 7);
  for (const char* text : {"7.6", "7.0", "1e1", "7 ", ""})
    EXPECT_TRUE(names(readWith("max_catch_up", value(text)).problems, "max_catch_up: must be an integer in [1, 1000]"));
  for (const char* text : {"1e-6 m", "0x10", "1,5", "", "nan", "inf", ".inf", " 1"})
    EXPECT_TRUE(names(readWith("obstacle_timeout", value(text)).problems, std::string("is the text \"") + text + '"'));
  XmlRpcValue scene = smallSceneParameters();
  scene["cloth"]["rows"] = value("4");
  scene["cloth"]["bending_warp"] = value("3e-06");
  scene["gravity"][0] = value("0");
  scene["gravity"][1] = value(0);
  scene["gravity"][2] = value("-.5");
  scene["wind"][0]["id"] = value("12");
  const ParameterReading reading = readScene(scene);
  ASSERT_TRUE(reading.problems.empty()) << reading.problems.front();
  EXPECT_EQ(reading.scene.cloth.rows, 4);
  EXPECT_EQ(reading.scene.cloth.bending_warp, 3e-6);
  EXPECT_EQ(reading.scene.gravity.z(), -0.5);
  EXPECT_EQ(reading.scene.wind.at(0).id, "12");
  XmlRpcValue robot, points;
  robot["padding"] = value("2e-3");
  points["rate"] = value("1e1");
  points["seed"] = value("7");
  EXPECT_EQ(readWith("robot", robot).robot->padding, 2e-3);
  EXPECT_EQ(readWith("points", points).points.rate, 10.0);
  EXPECT_EQ(readWith("points", points).points.seed, 7U);
}

// Parameters have no folder that a path could be relative to.
TEST(Parameters, MeshesOfTheSceneNeedAWholePath) {
  XmlRpcValue scene = smallSceneParameters();
  XmlRpcValue& statue = scene["obstacles"][0];
  statue["name"] = value("statue");
  statue["shape"] = value("mesh");
  statue["mesh"] = value("meshes/statue.stl");
  const std::vector<std::string> problems = readScene(scene).problems;
  EXPECT_EQ(problems.size(), 1U);
  EXPECT_TRUE(names(problems, "/stage/curtain/scene: obstacles[0].mesh: must be package://"));
  EXPECT_TRUE(names(problems, "is \"meshes/statue.stl\""));
  for (const char* good : {"/a/statue.stl", "file:///a/statue.stl", "file://localhost/a.stl", "package://p/a.stl"}) {
    statue["mesh"] = value(good);
    EXPECT_TRUE(readScene(scene).problems.empty()) << good;
  }
}

// Every key that a scene file can hold goes through the parameter tree unchanged.
TEST(Parameters, TreeAndFileGiveTheSameScene) {
  XmlRpcValue scene = smallSceneParameters();
  scene["cloth"]["height"] = value(1.7);
  scene["cloth"]["width"] = value(2);
  scene["gravity"][0] = value(0);
  scene["gravity"][1] = value(0.1);
  scene["gravity"][2] = value(-9.8);
  scene["wind"][0]["id"] = value("1");
  scene["wind"][0]["end"] = value(std::numeric_limits<double>::infinity());
  const ParameterReading reading = readScene(scene);
  EXPECT_TRUE(reading.problems.empty()) << reading.problems.front();
  const curtain::SceneReading file = curtain::readSceneText(
      "cloth: {rows: 10, columns: 8, height: 1.7, width: 2}\n"
      "gravity: [0, 0.1, -9.8]\n"
      "wind: [{id: '1', end: .inf}]\n");
  EXPECT_TRUE(file.problems.empty());
  EXPECT_EQ(curtain::writeScene(reading.scene), curtain::writeScene(file.scene));
}

TEST(Parameters, DefaultsNeedOnlyAScene) {
  XmlRpcValue tree;
  tree["scene"] = smallSceneParameters();
  const ParameterReading reading = readParameters(tree, "/stage/curtain");
  EXPECT_TRUE(reading.problems.empty());
  EXPECT_TRUE(reading.warnings.empty());
  EXPECT_EQ(reading.node.world_frame, "world");
  EXPECT_EQ(reading.scene.cloth.rows, 10);
}

TEST(Parameters, MissingSceneIsAProblem) {
  EXPECT_TRUE(names(readParameters(XmlRpcValue(), "/stage/curtain").problems, "/stage/curtain/scene: missing"));
  EXPECT_TRUE(names(readScene(value("curtain.yaml")).problems, "/stage/curtain/scene: must be a map"));
}

TEST(Parameters, WrongTypesAndRangesOfTheNodesOwnAreNamed) {
  EXPECT_TRUE(names(readWith("mesh_rate", value("1e1 Hz")).problems, "/stage/curtain/mesh_rate: must be a number"));
  EXPECT_TRUE(names(readWith("mesh_rate", value(0.0)).problems, "mesh_rate"));
  EXPECT_TRUE(names(readWith("mesh_rate", value(std::nan(""))).problems, "mesh_rate"));
  EXPECT_TRUE(names(readWith("state_rate", value(-1.0)).problems, "state_rate: must be a number in [0, 10000]"));
  EXPECT_TRUE(names(readWith("state_rest_rate", value(std::nan(""))).problems, "state_rest_rate"));
  EXPECT_TRUE(names(readWith("mesh_tolerance", value(-0.1)).problems, "mesh_tolerance"));
  EXPECT_TRUE(names(readWith("mesh_viewer_frame", value(3)).problems, "mesh_viewer_frame: must be text"));
  EXPECT_TRUE(names(readWith("mesh_viewer_tolerance", value(2.0)).problems, "mesh_viewer_tolerance"));
  EXPECT_TRUE(readWith("mesh_viewer_frame", value("")).problems.empty()) << "none";
  EXPECT_TRUE(names(readWith("state_rate", value("fast")).problems, "state_rate"));
  EXPECT_TRUE(readWith("state_rate", value(0)).problems.empty()) << "every frame";
  EXPECT_TRUE(names(readWith("obstacle_timeout", value(-1.0)).problems, "obstacle_timeout"));
  EXPECT_TRUE(names(readWith("max_catch_up", value(7.6)).problems, "max_catch_up: must be an integer"));
  EXPECT_TRUE(names(readWith("max_catch_up", value(0)).problems, "max_catch_up"));
  EXPECT_TRUE(names(readWith("handles", value(1)).problems, "handles: must be true or false"));
  EXPECT_TRUE(names(readWith("world_frame", value("")).problems, "world_frame"));
  EXPECT_TRUE(names(readWith("snapshot_file", value(1)).problems, "snapshot_file: must be text"));
  EXPECT_TRUE(
      names(readWith("snapshot_period", value(0.0)).problems, "snapshot_period: must be a number in [0.1, 86400]"));
  EXPECT_TRUE(names(readWith("diagnostic_period", value(0.0)).problems, "must be a number in [0.1, 3600]"));
  EXPECT_TRUE(names(readWith("world_frame", value(3)).problems, "world_frame"));
  EXPECT_TRUE(readWith("mesh_rate", value(25)).problems.empty()) << "an integer is a number";
}

TEST(Parameters, UnknownOnesAreWarnedOf) {
  const ParameterReading reading = readWith("mesh_rat", value(10.0));
  EXPECT_TRUE(reading.problems.empty());
  EXPECT_TRUE(names(reading.warnings, "/stage/curtain/mesh_rat: is not a known key, did you mean mesh_rate?"));
  EXPECT_EQ(reading.warnings.size(), 1U);
  const ParameterReading far = readWith("colour", value("red"));
  EXPECT_TRUE(names(far.warnings, "/stage/curtain/colour: is not a known key"));
  EXPECT_FALSE(names(far.warnings, "did you mean"));
}

// All problems at once, with the scene's dotted keys behind the parameter's name.
TEST(Parameters, SceneProblemsAreAllNamed) {
  XmlRpcValue scene = smallSceneParameters();
  scene["cloth"]["rows"] = value(1);
  scene["cloth"]["columns"] = value(8.0);
  scene["cloth"]["width"] = value("1e-6 m");
  scene["cloth"]["heigth"] = value(1.0);
  scene["gravity"] = value(std::nan(""));
  const std::vector<std::string> problems = readScene(scene).problems;
  for (const char* key : {"cloth.rows", "cloth.columns", "cloth.width", "cloth.heigth", "gravity"}) {
    EXPECT_TRUE(names(problems, std::string("/stage/curtain/scene: ") + key));
  }
}

// Obstacles that name no frame stand in the node's world frame, whatever its name; motions are not for the node.
TEST(Parameters, ObstaclesStandInTheWorldFrame) {
  XmlRpcValue scene = smallSceneParameters();
  scene["obstacles"][0]["name"] = value("ball");
  scene["obstacles"][0]["shape"] = value("sphere");
  scene["obstacles"][0]["radius"] = value(0.3);
  XmlRpcValue tree;
  tree["scene"] = scene;
  tree["world_frame"] = value("map");
  const ParameterReading reading = readParameters(tree, "/stage/curtain");
  ASSERT_TRUE(reading.problems.empty()) << reading.problems.front();
  EXPECT_EQ(reading.scene.obstacles.at(0).frame, "map");
  EXPECT_TRUE(reading.warnings.empty());
}

TEST(Parameters, MotionInTheWorldFrameIsWarnedOf) {
  XmlRpcValue scene = smallSceneParameters();
  XmlRpcValue& ball = scene["obstacles"][0];
  ball["name"] = value("ball");
  ball["shape"] = value("sphere");
  ball["radius"] = value(0.3);
  for (int i = 0; i < 3; ++i) ball["motion"][0]["position"][i] = value(0.0);
  ball["motion"][0]["time"] = value(0.0);
  const ParameterReading reading = readScene(scene);
  ASSERT_TRUE(reading.problems.empty()) << reading.problems.front();
  EXPECT_TRUE(names(reading.warnings, "ball"));
  EXPECT_TRUE(reading.scene.obstacles.at(0).motion.empty());
}

// Compares each parameter of the table with the manual's.
struct ManualReader {
  YAML::Node manual;
  std::set<std::string> known;

  template <typename T>
  void compare(const curtain::Key& key, const T& value) {
    ASSERT_TRUE(manual[key.name]) << key.name << " is not in the manual";
    EXPECT_EQ(manual[key.name].as<T>(), value) << key.name;
    known.insert(key.name);
  }
  void text(curtain::Key key, const std::string& value) { compare(key, value); }
  void textOrNone(curtain::Key key, const std::string& value) { compare(key, value); }
  void texts(curtain::Key key, const std::vector<std::string>& values) { compare(key, values); }
  void number(curtain::Key key, double value, curtain::Range) { compare(key, value); }
  void vector(curtain::Key key, const curtain::Vec3& value, curtain::Range) {
    compare(key, std::vector<double>(value.data(), value.data() + 3));
  }
  void integer(curtain::Key key, int value, curtain::IntRange) { compare(key, value); }
  void flag(curtain::Key key, bool value) { compare(key, value); }
};

// config/curtain.yaml is the manual: it has exactly the parameters that the node reads, with their defaults.
TEST(Parameters, ManualHasThemAllWithTheirDefaults) {
  ManualReader reader{YAML::LoadFile(std::string(CURTAIN_SOURCE_DIR) + "/config/curtain.yaml"), {}};
  const NodeParams defaults;
  curtain::visitFields(reader, defaults);
  reader.known.insert("scene");
  reader.known.insert("points");
  for (const auto& entry : reader.manual)
    EXPECT_EQ(reader.known.count(entry.first.as<std::string>()), 1U) << entry.first;
}

// The table of ~points. What has no default of its own stands in comments.
struct PointsManualReader : ManualReader {
  void seed(curtain::Key key, std::uint64_t value) { compare(key, value); }
  void optionalNumber(curtain::Key key, const std::optional<double>&, curtain::Range) {
    EXPECT_FALSE(manual[key.name]) << key.name;
  }
  void numbers(curtain::Key key, const std::vector<double>& values, curtain::Range) { compare(key, values); }
  template <typename Enum>
  void choice(curtain::Key key, Enum value, const std::vector<std::string>& names) {
    compare(key, names[static_cast<std::size_t>(value)]);
  }
  template <typename T>
  void map(curtain::Key key, const T& value) {
    PointsManualReader reader{{manual[key.name], {}}};
    curtain::visitFields(reader, value);
    EXPECT_EQ(reader.known.size(), reader.manual.size()) << key.name;
    known.insert(key.name);
  }
};

TEST(Parameters, ManualHasThoseOfPoints) {
  const YAML::Node manual = YAML::LoadFile(std::string(CURTAIN_SOURCE_DIR) + "/config/curtain.yaml");
  PointsManualReader reader{{manual["points"], {}}};
  const curtain::SensorParams defaults;
  curtain::visitFields(reader, defaults);
  EXPECT_EQ(reader.known.size(), reader.manual.size());
}

TEST(Parameters, PointsAreReadStrictly) {
  XmlRpcValue points;
  points["sensor"] = value("camera");
  points["camera"]["width"] = value(320);
  points["camera"]["distortion"][0] = value(-0.1);
  points["porosity"] = value(0.2);
  const ParameterReading good = readWith("points", points);
  ASSERT_TRUE(good.problems.empty()) << good.problems.front();
  EXPECT_EQ(good.points.sensor, curtain::SensorKind::kCamera);
  EXPECT_EQ(good.points.camera.width, 320);
  EXPECT_EQ(good.points.porosity, 0.2);

  points["camera"]["fx"] = value(0.0);
  points["camera"]["height"] = value(0);
  points["camera"]["fucus"] = value(1.0);
  points["lidar"]["lowest"] = value(0.5);
  points["noise"] = value("salt");
  points["min_range"] = value(30.0);
  points["rate"] = value("1e1 Hz");
  const std::vector<std::string> problems = readWith("points", points).problems;
  const std::string space = "/stage/curtain/points/";
  EXPECT_TRUE(names(problems, space + "camera.fx: must be a number in [0.001, 1000000], is 0"));
  EXPECT_TRUE(names(problems, space + "camera.height: must be an integer in [1, 8192], is 0"));
  EXPECT_TRUE(names(problems, space + "camera.fucus: is not a known key"));
  EXPECT_TRUE(names(problems, space + "lidar.lowest: must be at most lidar.highest, is 0.5"));
  EXPECT_TRUE(names(problems, space + "noise: must be none, gaussian, khoshelham_2012 or nguyen_2012"));
  EXPECT_TRUE(names(problems, space + "min_range: must be less than max_range, is 30"));
  EXPECT_TRUE(names(problems, space + "rate: must be a number"));
  EXPECT_TRUE(names(readWith("points", value("camera")).problems, "/stage/curtain/points: must be a map"));
}

TEST(Parameters, PointsMustGoTogether) {
  const auto problems = [](const char* sensor, const char* key, const XmlRpcValue& bad) {
    XmlRpcValue points;
    points["sensor"] = value(sensor);
    points[key] = bad;
    return readWith("points", points).problems;
  };
  EXPECT_TRUE(names(problems("all_round", "noise", value("gaussian")), "points/noise: must be none, is gaussian"));
  EXPECT_TRUE(names(problems("all_round", "dropout", value(0.1)), "points/dropout: must be 0, is 0.1"));
  EXPECT_TRUE(names(problems("lidar", "noise", value("nguyen_2012")), "points/noise: must be none or gaussian"));
  XmlRpcValue lidar, camera;
  lidar["rings"] = value(1024);
  lidar["columns"] = value(65536);
  EXPECT_TRUE(names(problems("lidar", "lidar", lidar), "points/lidar.rings: times lidar.columns must be at most"));
  camera["distortion"][0] = value(-3.0);
  EXPECT_TRUE(names(problems("camera", "camera", camera), "points/camera.distortion: has no inverse at the pixel"));
  EXPECT_TRUE(problems("lidar", "camera", camera).empty()) << "no camera is asked for";
  camera["distortion"].setSize(6);
  for (int i = 0; i < 6; ++i) camera["distortion"][i] = value(0.0);
  EXPECT_TRUE(names(problems("camera", "camera", camera), "points/camera.distortion: must have at most 5 numbers"));
}

// The robot's own table, which the manual shows as comments.
struct RobotManualReader : ManualReader {
  void texts(curtain::Key key, const std::vector<std::string>& values) { compare(key, values); }
  void numberOrUnset(curtain::Key key, double, curtain::Range) { known.insert(key.name); }
};

TEST(Parameters, ManualHasThoseOfTheRobot) {
  std::ifstream file(std::string(CURTAIN_SOURCE_DIR) + "/config/curtain.yaml");
  std::string line, text;
  while (std::getline(file, line)) {
    if (line.rfind("#   ", 0) == 0 || line.rfind("# robot:", 0) == 0) text += line.substr(2) + "\n";
  }
  const std::size_t begin = text.find("robot:");
  ASSERT_NE(begin, std::string::npos);
  RobotManualReader reader{{YAML::Load(text.substr(begin))["robot"], {}}};
  const RobotParams defaults;
  curtain::visitFields(reader, defaults);
  for (const auto& entry : reader.manual)
    EXPECT_EQ(reader.known.count(entry.first.as<std::string>()), 1U) << entry.first;
  EXPECT_EQ(reader.known.size(), reader.manual.size());
}

TEST(Parameters, RobotIsReadStrictly) {
  EXPECT_FALSE(readWith("mesh_rate", value(20.0)).robot.has_value()) << "none is asked for";
  XmlRpcValue robot;
  robot["links"][0] = value("arm_.*");
  robot["links"][1] = value("hand");
  robot["padding"] = value(0.01);
  robot["friction"] = value(0.5);
  robot["tf_prefix"] = value("left");
  const ParameterReading good = readWith("robot", robot);
  EXPECT_TRUE(good.problems.empty() && good.warnings.empty());
  ASSERT_TRUE(good.robot.has_value());
  EXPECT_EQ(good.robot->links, (std::vector<std::string>{"arm_.*", "hand"}));
  EXPECT_EQ(good.robot->padding, 0.01);
  EXPECT_EQ(good.robot->friction, 0.5);
  EXPECT_EQ(good.robot->tf_prefix, "left");
  EXPECT_TRUE(good.robot->visible);

  robot["padding"] = value(-0.01);
  robot["friction"] = value("rough");
  robot["links"][1] = value(3);
  robot["visible"] = value(1);
  robot["paddin"] = value(0.1);
  const std::vector<std::string> problems = readWith("robot", robot).problems;
  EXPECT_TRUE(names(problems, "/stage/curtain/robot/padding: must be a number in [0, "));
  EXPECT_TRUE(names(problems, "/stage/curtain/robot/friction: must be a number in [0, 10]"));
  EXPECT_TRUE(names(problems, "/stage/curtain/robot/links[1]: must be text"));
  EXPECT_TRUE(names(problems, "/stage/curtain/robot/visible: must be true or false"));
  EXPECT_TRUE(names(problems, "/stage/curtain/robot/paddin: is not a known key, did you mean padding?"));
  EXPECT_EQ(problems.size(), 5U);
  EXPECT_TRUE(names(readWith("robot", value("my_robot")).problems, "/stage/curtain/robot: must be a map"));
  EXPECT_TRUE(names(readWith("robot", flag(true)).problems, "/stage/curtain/robot: must be a map"));
}

// A description in the node's own namespace is no unknown parameter, where a robot is asked for.
TEST(Parameters, TheDescriptionIsKnown) {
  XmlRpcValue tree;
  tree["scene"] = smallSceneParameters();
  tree["robot_description"] = value("<robot/>");
  EXPECT_TRUE(names(readParameters(tree, "/stage/curtain").warnings, "robot_description: is not a known key"));
  tree["robot"]["visible"] = flag(false);
  EXPECT_TRUE(readParameters(tree, "/stage/curtain").warnings.empty());
  tree["urdf"] = value("<robot/>");
  tree["robot"]["description"] = value("urdf");
  EXPECT_TRUE(names(readParameters(tree, "/stage/curtain").warnings, "robot_description: is not a known key"));
}

// What only a file has, or only offline runs know.
TEST(Parameters, StartsElsewhereAreWhereTheNodeCanKnowThem) {
  XmlRpc::XmlRpcValue tree;
  tree["scene"] = smallSceneParameters();
  tree["scene"]["hang"]["start"]["file"] = std::string("towel.csv");
  ParameterReading reading = readParameters(tree, "/curtain");
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_NE(reading.problems[0].find("hang.start.file: must be"), std::string::npos) << reading.problems[0];
  XmlRpc::XmlRpcValue laid;
  laid["scene"] = smallSceneParameters();
  laid["scene"]["pins"] = std::string("none");
  laid["scene"]["hang"]["start"]["over"] = std::string("ball");
  laid["scene"]["obstacles"][0]["name"] = std::string("ball");
  laid["scene"]["obstacles"][0]["radius"] = 0.2;
  reading = readParameters(laid, "/curtain");
  EXPECT_TRUE(reading.problems.empty()) << reading.problems[0];
  laid["scene"]["obstacles"][0]["frame"] = std::string("gripper");
  reading = readParameters(laid, "/curtain");
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_NE(reading.problems[0].find("hang.start: needs all obstacles in the frame 'world'"), std::string::npos);
  XmlRpc::XmlRpcValue blind;
  blind["scene"] = smallSceneParameters();
  for (int axis = 0; axis < 3; ++axis) blind["summary_from"][axis] = 0.0;
  reading = readParameters(blind, "/curtain");
  ASSERT_EQ(reading.problems.size(), 1U);
  EXPECT_NE(reading.problems[0].find("summary_from: must have a length > 0"), std::string::npos);
}

}  // namespace
}  // namespace curtain_ros
