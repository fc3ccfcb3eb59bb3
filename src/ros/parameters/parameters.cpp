// SPDX-License-Identifier: BSD-3-Clause
#include "ros/parameters/parameters.h"

#include <ros/console.h>
#include <ros/exceptions.h>
#include <ros/param.h>
#include <ros/time.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <set>

#include "curtain_sim/CurtainConfig.h"
#include "curtain_sim/obstacle_shape.h"
#include "curtain_sim/scene_yaml.h"
#include "scene/layers.h"
#include "scene/range_checker.h"
#include "scene/strict_reader.h"

namespace curtain_ros {

using XmlRpc::XmlRpcValue;

namespace {

const char kScene[] = "scene";
const char kRobot[] = "robot";
const char kPoints[] = "points";
const char kDescription[] = "robot_description";  // where every tool looks for the URDF

// The scene's visitors, with the one kind of value that only nodes have: text that may be empty.
struct Reader : curtain::StrictReader {
  using StrictReader::StrictReader;
  void textOrNone(curtain::Key key, std::string& value) { text(key, value); }
};
struct Checker : curtain::RangeChecker {
  using RangeChecker::RangeChecker;
  void textOrNone(curtain::Key, const std::string&) {}
};

// The names of the node's own parameters.
struct Names {
  std::set<std::string> all;
  template <typename... Rest>
  void text(curtain::Key key, Rest&&...) {
    all.insert(key.name);
  }
  template <typename... Rest>
  void texts(curtain::Key key, Rest&&...) {
    all.insert(key.name);
  }
  template <typename... Rest>
  void textOrNone(curtain::Key key, Rest&&...) {
    all.insert(key.name);
  }
  template <typename... Rest>
  void vector(curtain::Key key, Rest&&...) {
    all.insert(key.name);
  }
  template <typename... Rest>
  void number(curtain::Key key, Rest&&...) {
    all.insert(key.name);
  }
  template <typename... Rest>
  void integer(curtain::Key key, Rest&&...) {
    all.insert(key.name);
  }
  template <typename... Rest>
  void flag(curtain::Key key, Rest&&...) {
    all.insert(key.name);
  }
};

// A scalar as the scene's reader knows it from a file: "!" is text, whatever it looks like, "?" is a value.
YAML::Node scalar(const std::string& text, const char* tag) {
  YAML::Node node(text);
  node.SetTag(tag);
  return node;
}

// The same tree, with its types: text is never a number, and a number with a fraction never an integer.
YAML::Node toYaml(const XmlRpcValue& value) {
  YAML::Node node;
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return scalar(static_cast<const bool&>(value) ? "true" : "false", "?");
    case XmlRpcValue::TypeInt:
      return scalar(std::to_string(static_cast<const int&>(value)), "?");
    case XmlRpcValue::TypeDouble:
      return scalar(curtain::formatYamlNumber(static_cast<const double&>(value)), "?");
    case XmlRpcValue::TypeString:
      return scalar(static_cast<const std::string&>(value), "!");
    case XmlRpcValue::TypeArray:
      node = YAML::Node(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) node.push_back(toYaml(value[i]));
      return node;
    case XmlRpcValue::TypeStruct:
      node = YAML::Node(YAML::NodeType::Map);
      for (const auto& entry : value) node[entry.first] = toYaml(entry.second);
      return node;
    default:
      return scalar("a date or binary data", "!");  // no key takes them
  }
}

void checkDirection(const NodeParams& params, curtain::ProblemLog& log) {
  if (log.good("summary_from") && !(params.summary_from.norm() > 0.0))
    log.add("summary_from", "must have a length > 0, is [0, 0, 0]");
}

// own: a map without the scene.
void readOwn(const YAML::Node& own, const std::string& space, ParameterReading& reading) {
  curtain::ProblemLog log;
  Reader reader(own, "", log);
  curtain::visitFields(reader, reading.node);
  Checker checker("", log);
  curtain::visitFields(checker, reading.node);
  checkDirection(reading.node, log);
  for (const curtain::Problem& problem : log.problems())
    reading.problems.push_back(space + curtain::describe({problem}));
  // Unknown ones do no harm: other nodes keep theirs there, too.
  const std::size_t known = log.problems().size();
  reader.reportUnknown();
  for (std::size_t i = known; i < log.problems().size(); ++i) {
    reading.warnings.push_back(space + curtain::describe({log.problems()[i]}));
  }
}

// Name of the parameter that holds the URDF.
std::string descriptionOf(const RobotParams& robot) {
  return robot.description.empty() ? kDescription : robot.description;
}

// A table of parameters that is refused as a whole. false: it is no map.
template <typename T>
bool readTable(const YAML::Node& yaml, const std::string& name, const char* keys, T& value, curtain::ProblemLog& log,
               std::vector<std::string>& problems) {
  if (!yaml.IsMap()) {
    problems.push_back(name + ": must be a map, with " + keys);
    return false;
  }
  Reader reader(yaml, "", log);
  curtain::visitFields(reader, value);
  reader.reportUnknown();
  Checker checker("", log);
  curtain::visitFields(checker, value);
  return true;
}

void addProblems(const curtain::ProblemLog& log, const std::string& name, std::vector<std::string>& problems) {
  for (const curtain::Problem& problem : log.problems()) problems.push_back(name + "/" + curtain::describe({problem}));
}

void readRobotTree(const YAML::Node& yaml, const std::string& name, ParameterReading& reading) {
  reading.robot.emplace();
  curtain::ProblemLog log;
  readTable(yaml, name, "description, links, …", *reading.robot, log, reading.problems);
  addProblems(log, name, reading.problems);
}

void readPointsTree(const YAML::Node& yaml, const std::string& name, ParameterReading& reading) {
  curtain::ProblemLog log;
  if (readTable(yaml, name, "sensor, rate, …", reading.points, log, reading.problems))
    curtain::checkSensor(reading.points, log);
  addProblems(log, name, reading.problems);
}

// Obstacles that name no frame stand still in the world, whatever the world frame is called here.
void fillObstacleFrames(const YAML::Node& scene, const std::string& world_frame) {
  const YAML::Node obstacles = scene["obstacles"];
  if (!obstacles || !obstacles.IsSequence()) return;
  for (YAML::Node obstacle : obstacles) {
    if (obstacle.IsMap() && !obstacle["frame"]) obstacle["frame"] = scalar(world_frame, "!");
  }
}

// The cloth is put there before tf2 is heard.
void checkStart(const curtain::Scene& scene, const std::string& name, ParameterReading& reading) {
  const curtain::StartParams& start = scene.hang.start;
  if (!curtain::startsElsewhere(scene)) return;
  if (start.file && !start.file->empty() && start.file->find("://") == std::string::npos && start.file->front() != '/')
    reading.problems.push_back(name + ": hang.start.file: must be " + kMeshPlaces + ", is " +
                               curtain::quoted(*start.file) + ": parameters have no folder");
  const std::string& world = reading.node.world_frame;
  const auto moves = [&](const curtain::ObstacleParams& obstacle) { return obstacle.frame != world; };
  if (reading.robot || std::any_of(scene.obstacles.begin(), scene.obstacles.end(), moves))
    reading.problems.push_back(name + ": hang.start: needs all obstacles in the frame '" + world +
                               "', and no robot: where others are is known later");
}

void readSceneTree(const YAML::Node& yaml, const std::string& name, ParameterReading& reading) {
  if (yaml.IsMap()) fillObstacleFrames(yaml, reading.node.world_frame);
  curtain::SceneReading scene = curtain::readScene(yaml);
  for (const curtain::Problem& problem : scene.problems) reading.problems.push_back(curtain::describe({problem}, name));
  for (std::size_t i = 0; i < scene.scene.obstacles.size(); ++i) {
    const curtain::ObstacleParams& obstacle = scene.scene.obstacles[i];
    if (isRelativeMesh(obstacle))
      reading.problems.push_back(name + ": " + curtain::itemKey("obstacles", i) + ".mesh: must be " + kMeshPlaces +
                                 ", is " + curtain::quoted(obstacle.mesh) + ": parameters have no folder");
  }
  checkStart(scene.scene, name, reading);
  // Motions are for offline runs. An obstacle on a frame of its own has tf2 instead; one in the world frame would stand
  // still without a word.
  for (curtain::ObstacleParams& obstacle : scene.scene.obstacles) {
    const bool steady =
        !obstacle.velocity.isZero(0.0) || !obstacle.acceleration.isZero(0.0) || !obstacle.spin.isZero(0.0);
    if ((!obstacle.motion.empty() || steady) && obstacle.frame == reading.node.world_frame) {
      reading.warnings.push_back(
          name + ": obstacle '" + obstacle.name +
          "': its motion is for curtain_batch and not used here; give the obstacle a frame to move it");
    }
    obstacle.motion.clear();
    obstacle.velocity = obstacle.acceleration = obstacle.spin = curtain::Vec3::Zero();
  }
  reading.scene = std::move(scene.scene);
}

// The URDF of the robot: in the private namespace, or the nearest one above it. Nothing: problems say why.
std::optional<std::string> findDescription(const ros::NodeHandle& node, const RobotParams& robot, std::string& name,
                                           std::vector<std::string>& problems) {
  const std::string wanted = descriptionOf(robot);
  const std::string asked = node.getNamespace() + "/" + kRobot + ": ";
  try {
    XmlRpcValue text;
    if (!node.searchParam(wanted, name) || !node.getParam(name, text)) {
      problems.push_back(asked + "there is no URDF: no parameter '" + wanted + "' in " + node.getNamespace() +
                         " or above it");
    } else if (text.getType() != XmlRpcValue::TypeString) {
      problems.push_back(name + ": must be the text of a URDF");
    } else {
      return static_cast<std::string>(text);
    }
  } catch (const ros::InvalidNameException& error) {
    problems.push_back(asked + "description: " + error.what());
  }
  return {};
}

void addRobot(const ros::NodeHandle& node, ParameterReading& reading) {
  std::string name;
  const std::optional<std::string> urdf = findDescription(node, *reading.robot, name, reading.problems);
  if (!urdf) return;
  const std::string asked = node.getNamespace() + "/" + kRobot + "/";
  RobotReading robot = readRobot(*reading.robot, *urdf);
  for (const curtain::Problem& problem : robot.problems)
    reading.problems.push_back((problem.key.empty() ? name : asked + problem.key) + ": " + problem.text);
  for (const std::string& problem : meshProblems(robot)) reading.problems.push_back(name + ": " + problem);
  for (curtain::ObstacleParams& obstacle : robot.obstacles) {
    const auto has_its_name = [&](const curtain::ObstacleParams& other) { return other.name == obstacle.name; };
    if (std::any_of(reading.scene.obstacles.begin(), reading.scene.obstacles.end(), has_its_name))
      reading.problems.push_back(name + ": the link '" + obstacle.name + "' has the name of an obstacle of the scene");
    reading.scene.obstacles.push_back(std::move(obstacle));
  }
}

// Those of the scene's own. The simulator, which would tell of them, is not going to be made.
void tryMeshes(const std::vector<curtain::ObstacleParams>& obstacles, const std::string& name,
               std::vector<std::string>& problems) {
  for (const curtain::ObstacleParams& obstacle : obstacles) {
    if (obstacle.shape != curtain::ShapeKind::kMesh || obstacle.mesh.empty() || isRelativeMesh(obstacle)) continue;
    try {
      curtain::makeObstacleShape(obstacle);
    } catch (const std::invalid_argument& error) {
      problems.push_back(name + ": " + error.what());
    }
  }
}

}  // namespace

std::vector<curtain::Problem> validate(const NodeParams& params) {
  curtain::ProblemLog log;
  Checker checker("", log);
  curtain::visitFields(checker, params);
  checkDirection(params, log);
  return log.problems();
}

std::vector<std::string> tunedSceneParameters() {
  Names own;
  NodeParams params;
  curtain::visitFields(own, params);
  std::vector<std::string> names;
  for (const auto& parameter : curtain_sim::CurtainConfig::__getParamDescriptions__()) {
    if (own.all.count(parameter->name) == 0) names.push_back(parameter->name);
  }
  return names;
}

ParameterReading readParameters(const XmlRpcValue& tree, const std::string& private_space) {
  YAML::Node own = tree.valid() ? toYaml(tree) : YAML::Node(YAML::NodeType::Map);
  const YAML::Node scene = static_cast<const YAML::Node&>(own)[kScene];
  own.remove(kScene);
  for (const std::string& name : tunedSceneParameters()) own.remove(name);
  const YAML::Node robot = static_cast<const YAML::Node&>(own)[kRobot];
  own.remove(kRobot);
  const YAML::Node points = static_cast<const YAML::Node&>(own)[kPoints];
  own.remove(kPoints);
  ParameterReading reading;
  if (points) readPointsTree(points, private_space + "/" + kPoints, reading);
  if (robot) {
    readRobotTree(robot, private_space + "/" + kRobot, reading);
    own.remove(descriptionOf(*reading.robot));
  }
  readOwn(own, private_space + "/", reading);
  const std::string scene_name = private_space + "/" + kScene;
  if (scene) {
    readSceneTree(scene, scene_name, reading);
  } else {
    reading.problems.push_back(
        scene_name + ": missing; load a scene file there: <rosparam command=\"load\" ns=\"scene\" file=\"...\"/>");
  }
  return reading;
}

ParameterReading readParameters(const ros::NodeHandle& private_node) {
  XmlRpcValue tree;
  ros::param::get(private_node.getNamespace(), tree);
  ParameterReading reading = readParameters(tree, private_node.getNamespace());
  const std::vector<curtain::ObstacleParams> own = reading.scene.obstacles;
  if (reading.robot) addRobot(private_node, reading);
  for (const std::string& warning : reading.warnings) ROS_WARN_STREAM(warning);
  if (reading.node.publish_clock && !ros::Time::isSimTime()) {
    reading.problems.push_back(
        private_node.getNamespace() +
        "/publish_clock: needs /use_sim_time: true, set before the node starts; without it nobody "
        "follows /clock");
  }
  if (reading.problems.empty()) return reading;
  tryMeshes(own, private_node.getNamespace() + "/" + kScene, reading.problems);
  std::string list = "can't start, " + std::to_string(reading.problems.size()) + " problem(s) with the parameters:";
  for (const std::string& problem : reading.problems) list += "\n  " + problem;
  throw ParameterError(list);
}

}  // namespace curtain_ros
