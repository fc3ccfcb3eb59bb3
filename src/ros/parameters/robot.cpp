// SPDX-License-Identifier: BSD-3-Clause
#include "ros/parameters/robot.h"

#include <console_bridge/console.h>
#include <urdf/model.h>

#include <map>
#include <regex>
#include <set>
#include <stdexcept>

#include "obstacles/mesh_loader.h"

namespace curtain_ros {

using curtain::ObstacleParams;
using curtain::ShapeKind;

namespace {

// Keeps the errors of the URDF's parser, which tells them to the log alone; the rest goes on to the log.
class ParserErrors : public console_bridge::OutputHandler {
 public:
  ParserErrors() : log_(console_bridge::getOutputHandler()) { console_bridge::useOutputHandler(this); }
  ~ParserErrors() override { console_bridge::useOutputHandler(log_); }
  ParserErrors(const ParserErrors&) = delete;
  ParserErrors& operator=(const ParserErrors&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* file, int line) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR)
      errors_.push_back(text);
    else if (log_ != nullptr)
      log_->log(text, level, file, line);
  }
  const std::vector<std::string>& errors() const { return errors_; }

 private:
  console_bridge::OutputHandler* log_;
  std::vector<std::string> errors_;
};

// "the link 'a'", "the links 'a', 'b'"
std::string linksInWords(const std::vector<std::string>& links) {
  std::string text = links.size() == 1 ? "the link " : "the links ";
  for (std::size_t i = 0; i < links.size(); ++i) text += (i == 0 ? "'" : ", '") + links[i] + "'";
  return text;
}

// The parser's errors. It tells of geometry that it does not know link by link: here that is one message a kind, with
// what to do.
std::string inWords(const std::vector<std::string>& errors) {
  const std::regex unknown("Unknown geometry type '(.*)'"), whose("Could not parse \\w+ element for Link \\[(.*)\\]");
  std::map<std::string, std::vector<std::string>> links_of;  // by kind of geometry
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    std::smatch kind, link;
    if (i + 1 < errors.size() && std::regex_match(errors[i], kind, unknown) &&
        std::regex_match(errors[i + 1], link, whose)) {
      links_of[kind[1]].push_back(link[1]);
      ++i;
    } else {
      texts.push_back(errors[i]);
    }
  }
  for (const auto& [kind, links] : links_of) {
    texts.push_back("Unknown geometry type '" + kind + "' of " + linksInWords(links) +
                    ": URDF has box, cylinder, sphere and mesh");
    if (kind == "capsule")
      texts.back() += "; a capsule is a cylinder and two spheres, each a <collision> of its own, or a mesh";
  }
  std::string text;
  for (const std::string& one : texts) text += (text.empty() ? "" : "; ") + one;
  return text;
}

std::vector<urdf::CollisionSharedPtr> geometriesOf(const urdf::Link& link) {
  if (!link.collision_array.empty()) return link.collision_array;
  if (link.collision) return {link.collision};
  return {};
}

// The links that an entry of ~robot/links names. Throws std::regex_error.
std::set<std::string> linksNamed(const std::string& entry, const urdf::Model& model) {
  if (model.links_.count(entry) > 0) return {entry};
  const std::regex expression(entry);
  std::set<std::string> names;
  for (const auto& [name, link] : model.links_) {
    if (std::regex_match(name, expression)) names.insert(name);
  }
  return names;
}

bool anyCollides(const std::set<std::string>& names, const urdf::Model& model) {
  for (const std::string& name : names) {
    if (!geometriesOf(*model.links_.at(name)).empty()) return true;
  }
  return false;
}

std::set<std::string> chosenLinks(const RobotParams& params, const urdf::Model& model, RobotReading& reading) {
  std::set<std::string> chosen;
  const auto refuse = [&](const std::string& entry, const std::string& why) {
    reading.problems.push_back({"links", "'" + entry + "' " + why});
  };
  for (const std::string& entry : params.links) {
    try {
      const std::set<std::string> names = linksNamed(entry, model);
      if (names.empty())
        refuse(entry, "names no link of '" + model.getName() + "'");
      else if (!anyCollides(names, model))
        refuse(entry, "names no link with collision geometry");
      chosen.insert(names.begin(), names.end());
    } catch (const std::regex_error& error) {
      refuse(entry, std::string("is no link and no regular expression: ") + error.what());
    }
  }
  if (!params.links.empty()) return chosen;
  for (const auto& [name, link] : model.links_) chosen.insert(name);
  if (!anyCollides(chosen, model))
    reading.problems.push_back({"", "no link of '" + model.getName() + "' has collision geometry"});
  return chosen;
}

void setShape(const urdf::Geometry& geometry, ObstacleParams& obstacle) {
  switch (geometry.type) {
    case urdf::Geometry::SPHERE:
      obstacle.shape = ShapeKind::kSphere;
      obstacle.radius = static_cast<const urdf::Sphere&>(geometry).radius;
      return;
    case urdf::Geometry::BOX: {
      const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
      obstacle.shape = ShapeKind::kBox;
      obstacle.size = curtain::Vec3(size.x, size.y, size.z);
      return;
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      obstacle.shape = ShapeKind::kCylinder;
      obstacle.radius = cylinder.radius;
      obstacle.length = cylinder.length;
      return;
    }
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
      obstacle.shape = ShapeKind::kMesh;
      obstacle.mesh = mesh.filename;
      obstacle.scale = curtain::Vec3(mesh.scale.x, mesh.scale.y, mesh.scale.z);
      return;
    }
  }
}

ObstacleParams obstacleOf(const RobotParams& params, const std::string& link, const urdf::Collision& collision) {
  ObstacleParams obstacle;
  obstacle.frame = params.tf_prefix.empty() ? link : params.tf_prefix + "/" + link;
  const urdf::Pose& origin = collision.origin;
  obstacle.pose.position = curtain::Vec3(origin.position.x, origin.position.y, origin.position.z);
  const urdf::Rotation& turn = origin.rotation;
  obstacle.pose.orientation = Eigen::Quaterniond(turn.w, turn.x, turn.y, turn.z).normalized();
  setShape(*collision.geometry, obstacle);
  return obstacle;
}

}  // namespace

RobotReading readRobot(const RobotParams& params, const std::string& urdf) {
  RobotReading reading;
  urdf::Model model;
  {
    ParserErrors errors;
    const bool whole = model.initString(urdf);
    if (!whole || !errors.errors().empty()) {  // with some errors it only leaves out what it can't read
      reading.problems.push_back({"", "is not a valid URDF: " + inWords(errors.errors())});
      return reading;
    }
  }
  for (const std::string& link : chosenLinks(params, model, reading)) {
    const std::vector<urdf::CollisionSharedPtr> geometries = geometriesOf(*model.links_.at(link));
    for (std::size_t k = 0; k < geometries.size(); ++k) {
      ObstacleParams obstacle = obstacleOf(params, link, *geometries[k]);
      obstacle.name = geometries.size() == 1 ? link : link + "/" + std::to_string(k);
      const std::vector<curtain::Problem> problems = validate(obstacle, "");
      for (const curtain::Problem& problem : problems)
        reading.problems.push_back({"", "collision geometry '" + obstacle.name + "': " + curtain::describe({problem})});
      if (!problems.empty()) continue;
      obstacle.padding = params.padding;
      obstacle.friction = params.friction;
      obstacle.visible = params.visible;
      reading.obstacles.push_back(obstacle);
      reading.links.push_back(link);
    }
  }
  return reading;
}

const char* const kMeshPlaces = "package://PACKAGE/PATH, file:///PATH or a whole path";

bool isRelativeMesh(const ObstacleParams& obstacle) {
  return obstacle.shape == ShapeKind::kMesh && !obstacle.mesh.empty() &&
         obstacle.mesh.find("://") == std::string::npos && obstacle.mesh[0] != '/';
}

std::vector<std::string> meshProblems(const RobotReading& robot) {
  std::vector<std::string> problems, links;
  std::string path;
  for (std::size_t i = 0; i < robot.obstacles.size(); ++i) {
    const ObstacleParams& obstacle = robot.obstacles[i];
    if (obstacle.shape != ShapeKind::kMesh) continue;
    if (isRelativeMesh(obstacle)) {
      if (path.empty()) path = obstacle.mesh;
      if (links.empty() || links.back() != robot.links[i]) links.push_back(robot.links[i]);
      continue;
    }
    try {
      curtain::loadMesh(obstacle);
    } catch (const std::invalid_argument& error) {
      problems.push_back("the link '" + robot.links[i] + "': " + error.what());
    }
  }
  if (!links.empty())
    problems.push_back("meshes of " + linksInWords(links) + " must be " + kMeshPlaces + ", are relative paths, as '" +
                       path + "': a URDF on the parameter server has no folder");
  return problems;
}

}  // namespace curtain_ros
