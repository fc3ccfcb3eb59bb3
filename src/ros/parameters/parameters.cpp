// SPDX-License-Identifier: BSD-3-Clause
#include "ros/parameters/parameters.h"

#include <ros/console.h>
#include <ros/param.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>

#include "curtain_sim/scene_yaml.h"
#include "ros/parameters/xmlrpc_yaml.h"
#include "scene/spelling.h"

namespace curtain_ros {

using XmlRpc::XmlRpcValue;

namespace {

const char kScene[] = "scene";

// A reader sets its field, or returns what is wrong.
using Reader = std::function<std::string(const XmlRpcValue&, NodeParams&)>;

// NaN: it is none.
double numberOf(const XmlRpcValue& value) {
  if (value.getType() == XmlRpcValue::TypeDouble) return static_cast<const double&>(value);
  if (value.getType() == XmlRpcValue::TypeInt) return static_cast<const int&>(value);
  return std::nan("");
}

Reader number(double NodeParams::*field, double largest, const std::string& unit) {
  return [=](const XmlRpcValue& value, NodeParams& params) -> std::string {
    const double number = numberOf(value);
    if (!(number > 0.0 && number <= largest)) {
      return "must be a number in (0, " + yamlText(largest) + "] " + unit + ", is " + describeValue(value);
    }
    params.*field = number;
    return "";
  };
}

Reader numberBetween(double NodeParams::*field, double smallest, double largest, const std::string& unit) {
  return [=](const XmlRpcValue& value, NodeParams& params) -> std::string {
    const double number = numberOf(value);
    if (!(number >= smallest && number <= largest)) {
      return "must be a number in [" + yamlText(smallest) + ", " + yamlText(largest) + "] " + unit + ", is " +
             describeValue(value);
    }
    params.*field = number;
    return "";
  };
}

Reader numberOrZero(double NodeParams::*field, double largest, const std::string& unit) {
  return numberBetween(field, 0.0, largest, unit);
}

Reader integer(int NodeParams::*field, int smallest, int largest) {
  return [=](const XmlRpcValue& value, NodeParams& params) -> std::string {
    const bool right = value.getType() == XmlRpcValue::TypeInt;
    if (!right || static_cast<const int&>(value) < smallest || static_cast<const int&>(value) > largest) {
      return "must be an integer in [" + std::to_string(smallest) + ", " + std::to_string(largest) + "], is " +
             describeValue(value);
    }
    params.*field = static_cast<const int&>(value);
    return "";
  };
}

Reader boolean(bool NodeParams::*field) {
  return [=](const XmlRpcValue& value, NodeParams& params) -> std::string {
    if (value.getType() != XmlRpcValue::TypeBoolean) return "must be true or false, is " + describeValue(value);
    params.*field = static_cast<const bool&>(value);
    return "";
  };
}

Reader text(std::string NodeParams::*field) {
  return [=](const XmlRpcValue& value, NodeParams& params) -> std::string {
    if (value.getType() != XmlRpcValue::TypeString || static_cast<const std::string&>(value).empty()) {
      return "must be a text that is not empty, is " + describeValue(value);
    }
    params.*field = static_cast<const std::string&>(value);
    return "";
  };
}

Reader textOrEmpty(std::string NodeParams::*field) {
  return [=](const XmlRpcValue& value, NodeParams& params) -> std::string {
    if (value.getType() != XmlRpcValue::TypeString) return "must be a text, is " + describeValue(value);
    params.*field = static_cast<const std::string&>(value);
    return "";
  };
}

const std::map<std::string, Reader>& readers() {
  static const std::map<std::string, Reader> table = {
      {"world_frame", text(&NodeParams::world_frame)},
      {"obstacle_timeout", number(&NodeParams::obstacle_timeout, 3600.0, "[s]")},
      {"state_rate", numberOrZero(&NodeParams::state_rate, 10000.0, "[1/s]")},
      {"state_rest_rate", numberOrZero(&NodeParams::state_rest_rate, 10000.0, "[1/s]")},
      {"mesh_rate", number(&NodeParams::mesh_rate, 10000.0, "[1/s]")},
      {"mesh_tolerance", numberOrZero(&NodeParams::mesh_tolerance, 1000.0, "[m]")},
      {"mesh_viewer_frame", textOrEmpty(&NodeParams::mesh_viewer_frame)},
      {"mesh_viewer_tolerance", numberOrZero(&NodeParams::mesh_viewer_tolerance, 1.0, "[rad]")},
      {"markers_rate", number(&NodeParams::markers_rate, 10000.0, "[1/s]")},
      {"max_catch_up", integer(&NodeParams::max_catch_up, 1, 1000)},
      {"state_folds", boolean(&NodeParams::state_folds)},
      {"handles", boolean(&NodeParams::handles)},
      {"handle_stiffness", number(&NodeParams::handle_stiffness, 1e6, "[N/m]")},
      {"snapshot_file", textOrEmpty(&NodeParams::snapshot_file)},
      {"snapshot_period", numberBetween(&NodeParams::snapshot_period, 0.1, 86400.0, "[s]")},
      {"diagnostic_period", numberBetween(&NodeParams::diagnostic_period, 0.1, 3600.0, "[s]")},
  };
  return table;
}

// What a mistyped parameter was meant to be, as far as one can tell.
std::string meant(const std::string& name) {
  std::vector<std::string> known = nodeParameterNames();
  known.push_back(kScene);
  const std::optional<std::string> word = curtain::nearestWord(name, known);
  return word ? "; did you mean " + *word + "?" : "";
}

// Obstacles that name no frame stand still in the world, whatever the world frame is called here.
void fillObstacleFrames(YAML::Node& scene, const std::string& world_frame) {
  if (!scene.IsMap()) return;
  YAML::Node obstacles = static_cast<const YAML::Node&>(scene)["obstacles"];
  if (!obstacles || !obstacles.IsSequence()) return;
  for (YAML::Node obstacle : obstacles) {
    if (!obstacle.IsMap() || obstacle["frame"]) continue;
    YAML::Node frame(world_frame);
    frame.SetTag("!");
    obstacle["frame"] = frame;
  }
}

void readSceneTree(const XmlRpcValue& tree, const std::string& name, ParameterReading& reading) {
  YAML::Node yaml = toYaml(tree);
  fillObstacleFrames(yaml, reading.node.world_frame);
  curtain::SceneReading scene = curtain::readScene(yaml);
  for (const curtain::Problem& problem : scene.problems) {
    reading.problems.push_back(curtain::describe({problem}, name));
  }
  // Motions are for offline runs. An obstacle on a frame of its own has tf2 instead; one in the world frame
  // would silently stand still.
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

std::vector<std::string> nodeParameterNames() {
  std::vector<std::string> names;
  for (const auto& reader : readers()) names.push_back(reader.first);
  return names;
}

ParameterReading readParameters(const XmlRpcValue& tree, const std::string& private_space) {
  ParameterReading reading;
  const XmlRpcValue* scene = nullptr;
  if (tree.getType() == XmlRpcValue::TypeStruct) {
    for (const auto& entry : tree) {
      const std::string name = private_space + "/" + entry.first;
      if (entry.first == kScene) {
        scene = &entry.second;
        continue;
      }
      const auto reader = readers().find(entry.first);
      if (reader == readers().end()) {
        reading.warnings.push_back(name + ": unknown parameter, not used" + meant(entry.first));
        continue;
      }
      const std::string problem = reader->second(entry.second, reading.node);
      if (!problem.empty()) reading.problems.push_back(name + ": " + problem);
    }
  }
  const std::string scene_name = private_space + "/" + kScene;
  if (scene == nullptr) {
    reading.problems.push_back(scene_name +
                               ": missing; load a scene file there: <rosparam command=\"load\" ns=\"scene\" "
                               "file=\"...\"/>");
  } else if (scene->getType() != XmlRpcValue::TypeStruct) {
    reading.problems.push_back(scene_name + ": must be a dictionary, is " + describeValue(*scene));
  } else {
    readSceneTree(*scene, scene_name, reading);
  }
  return reading;
}

ParameterReading readParameters(const ros::NodeHandle& private_node) {
  XmlRpcValue tree;
  ros::param::get(private_node.getNamespace(), tree);
  ParameterReading reading = readParameters(tree, private_node.getNamespace());
  for (const std::string& warning : reading.warnings) ROS_WARN_STREAM(warning);
  if (!reading.problems.empty()) {
    std::string list = "can't start, " + std::to_string(reading.problems.size()) + " problem(s) with the parameters:";
    for (const std::string& problem : reading.problems) list += "\n  " + problem;
    throw ParameterError(list);
  }
  return reading;
}

}  // namespace curtain_ros
