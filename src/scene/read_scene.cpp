// SPDX-License-Identifier: BSD-3-Clause
//
// Reads scenes from a YAML tree, text or file: types first (StrictReader), then values (checkScene), all problems at
// once.
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "curtain_sim/scene_yaml.h"
#include "scene/checks.h"
#include "scene/names.h"
#include "scene/strict_reader.h"
#include "scene/yaml_text.h"

namespace curtain {
namespace {

SceneReading failed(const std::string& text) {
  SceneReading reading;
  reading.problems.push_back({"", text});
  return reading;
}

// Relative paths are relative to the scene file; URLs and absolute paths stay.
std::string resolvePath(const std::string& mesh, const std::filesystem::path& folder) {
  if (mesh.empty() || mesh.find("://") != std::string::npos || std::filesystem::path(mesh).is_absolute()) return mesh;
  return (folder / mesh).lexically_normal().string();
}

// Reads a file, at most so far that it is known to be too long (it may be endless).
std::string readText(std::istream& file) {
  std::string text;
  std::vector<char> block(std::size_t{1} << 16U);
  while (file && text.size() <= kLongestYaml) {
    file.read(block.data(), static_cast<std::streamsize>(block.size()));
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  return text;
}

// A fullness gives the width where that is left out.
void applyFullness(const YAML::Node& root, Scene& scene) {
  const YAML::Node cloth = root["cloth"];
  const bool has_width = cloth.IsDefined() && cloth.IsMap() && cloth["width"].IsDefined();
  const double span = (scene.hang.to - scene.hang.from).norm();
  if (scene.hang.fullness && !has_width && !scene.cloth.closed && span > 0.0)
    scene.cloth.width = *scene.hang.fullness * span;
}

// The material comes first: the other keys are read over it. Whatever else it may be is a problem that the reader
// finds.
void applyMaterial(const YAML::Node& root, Scene& scene) {
  const YAML::Node cloth = root["cloth"];
  if (!cloth.IsDefined() || !cloth.IsMap()) return;
  const YAML::Node name = cloth["material"];
  if (!name.IsDefined() || !name.IsScalar()) return;
  const auto& names = materialNames();
  const auto found = std::find(names.begin(), names.end(), name.Scalar());
  if (found == names.end()) return;
  const YAML::Node air = root["air"];
  if (air.IsDefined() && air.IsMap() && air["law"].IsDefined() && air["law"].IsScalar() &&
      air["law"].Scalar() == airLawNames()[static_cast<std::size_t>(AirLaw::kRelative)])
    scene.air.law = AirLaw::kRelative;
  applyMaterial(static_cast<Material>(found - names.begin()), scene);
}

}  // namespace

SceneReading readScene(const YAML::Node& root) {
  try {
    if (!root.IsDefined() || root.IsNull()) return failed("is empty, must be a map with at least cloth: rows, columns");
    if (!root.IsMap()) return failed("must be a map with at least cloth: rows, columns, is " + describeValue(root));
    SceneReading reading;
    ProblemLog log;
    applyMaterial(root, reading.scene);
    StrictReader::readMap(root, "", reading.scene, log);
    applyFullness(root, reading.scene);
    checkScene(reading.scene, log);
    reading.problems = log.problems();
    return reading;
  } catch (const YAML::Exception& error) {
    return failed(std::string("can't be read: ") + error.what());
  }
}

SceneReading readSceneText(const std::string& text) {
  YAML::Node root;
  std::string problem;
  return loadYaml(text, root, problem) ? readScene(root) : failed(problem);
}

SceneReading readSceneFile(const std::string& path) {
  std::error_code ignored;  // opening the file fails too then, and that is reported
  const bool is_folder = std::filesystem::is_directory(path, ignored);
  std::ifstream file(path, std::ios::binary);
  if (is_folder || !file) {
    return failed("can't open " + path + ": " + (is_folder ? "is a folder" : std::generic_category().message(errno)));
  }
  SceneReading reading = readSceneText(readText(file));
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (ObstacleParams& obstacle : reading.scene.obstacles) obstacle.mesh = resolvePath(obstacle.mesh, folder);
  std::optional<std::string>& start = reading.scene.hang.start.file;
  if (start) start = resolvePath(*start, folder);
  return reading;
}

}  // namespace curtain
