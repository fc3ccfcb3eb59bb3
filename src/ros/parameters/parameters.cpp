// SPDX-License-Identifier: BSD-3-Clause
#include "ros/parameters/parameters.h"

#include <ros/console.h>
#include <ros/param.h>
#include <ros/time.h>
#include <yaml-cpp/yaml.h>

#include <set>

#include "curtain_sim/CurtainConfig.h"
#include "curtain_sim/scene_yaml.h"
#include "scene/range_checker.h"
#include "scene/strict_reader.h"

namespace curtain_ros {

using XmlRpc::XmlRpcValue;

namespace {

const char kScene[] = "scene";

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
  void textOrNone(curtain::Key key, Rest&&...) {
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

// own: a map without the scene.
void readOwn(const YAML::Node& own, const std::string& space, ParameterReading& reading) {
  curtain::ProblemLog log;
  Reader reader(own, "", log);
  curtain::visitFields(reader, reading.node);
  Checker checker("", log);
  curtain::visitFields(checker, reading.node);
  for (const curtain::Problem& problem : log.problems())
    reading.problems.push_back(space + curtain::describe({problem}));
  // Unknown ones do no harm: other nodes keep theirs there, too.
  const std::size_t known = log.problems().size();
  reader.reportUnknown();
  for (std::size_t i = known; i < log.problems().size(); ++i) {
    reading.warnings.push_back(space + curtain::describe({log.problems()[i]}));
  }
}

// Obstacles that name no frame stand still in the world, whatever the world frame is called here.
void fillObstacleFrames(const YAML::Node& scene, const std::string& world_frame) {
  const YAML::Node obstacles = scene["obstacles"];
  if (!obstacles || !obstacles.IsSequence()) return;
  for (YAML::Node obstacle : obstacles) {
    if (obstacle.IsMap() && !obstacle["frame"]) obstacle["frame"] = scalar(world_frame, "!");
  }
}

void readSceneTree(const YAML::Node& yaml, const std::string& name, ParameterReading& reading) {
  if (yaml.IsMap()) fillObstacleFrames(yaml, reading.node.world_frame);
  curtain::SceneReading scene = curtain::readScene(yaml);
  for (const curtain::Problem& problem : scene.problems) reading.problems.push_back(curtain::describe({problem}, name));
  // Motions are for offline runs. An obstacle on a frame of its own has tf2 instead; one in the world frame would stand
  // still without a word.
  for (curtain::ObstacleParams& obstacle : scene.scene.obstacles) {
    if (!obstacle.motion.empty() && obstacle.frame == reading.node.world_frame) {
      reading.warnings.push_back(
          name + ": obstacle '" + obstacle.name +
          "': motion is for curtain_batch and not used here; give the obstacle a frame to move it");
    }
    obstacle.motion.clear();
  }
  reading.scene = std::move(scene.scene);
}

}  // namespace

std::vector<curtain::Problem> validate(const NodeParams& params) {
  curtain::ProblemLog log;
  Checker checker("", log);
  curtain::visitFields(checker, params);
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
  ParameterReading reading;
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
  for (const std::string& warning : reading.warnings) ROS_WARN_STREAM(warning);
  if (reading.node.publish_clock && !ros::Time::isSimTime()) {
    reading.problems.push_back(
        private_node.getNamespace() +
        "/publish_clock: needs /use_sim_time: true, set before the node starts; without it nobody "
        "follows /clock");
  }
  if (reading.problems.empty()) return reading;
  std::string list = "can't start, " + std::to_string(reading.problems.size()) + " problem(s) with the parameters:";
  for (const std::string& problem : reading.problems) list += "\n  " + problem;
  throw ParameterError(list);
}

}  // namespace curtain_ros
