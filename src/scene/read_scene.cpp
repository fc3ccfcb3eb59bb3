// SPDX-License-Identifier: BSD-3-Clause
//
// Reads scenes from a YAML tree, text or file: types first (StrictReader), then values (checkScene), all problems at
// once.
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <optional>
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

// A map under a key; undefined: there is none.
YAML::Node mapIn(const YAML::Node& map, const char* key) {
  const YAML::Node found = map.IsMap() ? map[key] : YAML::Node(YAML::NodeType::Undefined);
  return found.IsDefined() && found.IsMap() ? found : YAML::Node(YAML::NodeType::Undefined);
}

// A fullness gives the width where that is left out.
void applyFullness(const YAML::Node& root, const HangParams& hang, ClothParams& cloth) {
  const YAML::Node map = mapIn(root, "cloth");
  const bool has_width = map.IsDefined() && map["width"].IsDefined();
  const double span = (hang.to - hang.from).norm();
  if (hang.fullness && !has_width && !cloth.closed && span > 0.0) cloth.width = *hang.fullness * span;
}

std::optional<std::size_t> placeOfName(const YAML::Node& map, const char* key, const std::vector<std::string>& names) {
  if (!map.IsDefined() || !map[key].IsDefined() || !map[key].IsScalar()) return std::nullopt;
  const auto found = std::find(names.begin(), names.end(), map[key].Scalar());
  return found == names.end() ? std::nullopt : std::optional<std::size_t>(found - names.begin());
}

// The material comes first: the other keys are read over it. Whatever else it may be is a problem that the reader
// finds.
std::optional<Material> materialOf(const YAML::Node& cloth) {
  const std::optional<std::size_t> place = placeOfName(cloth, "material", materialNames());
  return place ? std::optional<Material>(static_cast<Material>(*place)) : std::nullopt;
}
std::optional<Material> materialIn(const YAML::Node& root) { return materialOf(mapIn(root, "cloth")); }

void applyMaterial(const YAML::Node& root, Scene& scene) {
  const std::optional<Material> material = materialIn(root);
  if (!material) return;
  const std::optional<std::size_t> law = placeOfName(mapIn(root, "air"), "law", airLawNames());
  if (law && static_cast<AirLaw>(*law) == AirLaw::kRelative) scene.air.law = AirLaw::kRelative;
  applyMaterial(*material, scene);
}

// Patches and layers are read again over their materials; what is wrong with them is known.
void readPatchesAgain(const YAML::Node& root, ClothParams& cloth) {
  for (std::size_t k = 0; k < cloth.patches.size(); ++k) {
    const YAML::Node map = root["cloth"]["patches"][k];
    const std::optional<Material> material = map.IsMap() ? materialOf(map) : std::nullopt;
    if (!material) continue;
    cloth.patches[k] = {};
    applyMaterial(*material, cloth.patches[k]);
    ProblemLog known;
    StrictReader::readMap(map, itemKey("cloth.patches", k), cloth.patches[k], known);
  }
}

void readLayersAgain(const YAML::Node& root, Scene& scene) {
  for (std::size_t k = 0; k < scene.layers.size(); ++k) {
    const YAML::Node map = root["layers"][k];
    const std::optional<Material> material = materialIn(map);
    LayerParams& layer = scene.layers[k];
    if (material) {
      layer = layerBeside(scene);
      applyMaterial(*material, scene, layer);
      ProblemLog known;
      StrictReader::readMap(map, itemKey("layers", k), layer, known);
    }
    readPatchesAgain(map, layer.cloth);
    applyFullness(map, layer.hang, layer.cloth);
  }
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
    readPatchesAgain(root, reading.scene.cloth);
    applyFullness(root, reading.scene.hang, reading.scene.cloth);
    readLayersAgain(root, reading.scene);
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
