// SPDX-License-Identifier: BSD-3-Clause
//
// config/curtain.yaml documents exactly the keys that the parser knows, with their defaults.
//
// Keys that are off by default, and the entries of lists, stand there as comments of the form "# key: value  #
// meaning". The tests take the marks away, empty lists give way to their entries, and the rest is plain YAML.
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "known_keys.h"
#include "scene/scene_testing.h"

namespace curtain {
namespace {

std::string templateText() {
  std::ifstream file(std::string(CURTAIN_SOURCE_DIR) + "/config/curtain.yaml");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_FALSE(text.str().empty());
  return text.str();
}

std::string withCommentedKeys(const std::string& text) {
  static const std::regex kCommentedKey("^( *)# ( *(- )?[a-z_]+: .*# .*)$");
  static const std::regex kEmptyLists("^  ([a-z_]+): \\[\\]$");
  std::stringstream in(text);
  std::string line, out;
  while (std::getline(in, line)) {
    line = std::regex_replace(line, kEmptyLists, "  $1:");
    out += std::regex_replace(line, kCommentedKey, "$1$2") + "\n";
  }
  return out;
}

bool isListOfMaps(const YAML::Node& node) { return node.IsSequence() && node.size() > 0 && node[0].IsMap(); }

void collectKeys(const YAML::Node& map, const std::string& prefix, std::set<std::string>& keys) {
  for (const auto& entry : map) {
    const std::string key = prefix + entry.first.Scalar();
    if (entry.second.IsMap()) {
      collectKeys(entry.second, key + ".", keys);
    } else if (isListOfMaps(entry.second)) {
      for (const YAML::Node& item : entry.second) collectKeys(item, key + "[].", keys);
    } else {
      keys.insert(key);
    }
  }
}

std::set<std::string> sceneKeys(const std::string& text) {
  std::set<std::string> keys;
  collectKeys(YAML::Load(text)["scene"], "", keys);
  return keys;
}

TEST(KnownKeys, AreSortedWithoutRepeatsListsWithBrackets) {
  const std::vector<std::string> keys = knownSceneKeys();
  EXPECT_TRUE(std::is_sorted(keys.begin(), keys.end()));
  const std::set<std::string> set(keys.begin(), keys.end());
  EXPECT_EQ(set.size(), keys.size());
  for (const char* key : {"cloth.rows", "pins", "gravity", "hang.radius", "wind[].radius", "drag[].node",
                          "obstacles[].motion[].time", "obstacles[].size", "solver.seed"}) {
    EXPECT_EQ(set.count(key), 1u) << key;
  }
}

// A layer's keys are documented where the first cloth has them.
TEST(Template, DocumentsExactlyTheKnownKeys) {
  const std::string of_layer = "layers[].";
  const std::vector<std::string> keys = knownSceneKeys();
  const std::set<std::string> known(keys.begin(), keys.end()),
      documented = sceneKeys(withCommentedKeys(templateText()));
  for (const std::string& key : documented) EXPECT_EQ(known.count(key), 1u) << key;
  for (const std::string& key : known) {
    const bool as_first = key.rfind(of_layer, 0) == 0 && documented.count(key.substr(of_layer.size())) == 1;
    EXPECT_TRUE(as_first || documented.count(key) == 1) << key;
  }
}

TEST(Template, EveryKeyHasAComment) {
  std::stringstream in(withCommentedKeys(templateText()));
  static const std::regex kKey("^ *(- )?[a-z_]+: *[^# ].*$");
  std::size_t count = 0;
  for (std::string line; std::getline(in, line);) {
    if (!std::regex_match(line, kKey)) continue;
    ++count;
    EXPECT_NE(line.find("  # "), std::string::npos) << line;
  }
  EXPECT_GE(count, knownSceneKeys().size());
}

TEST(Template, StatesTheDefaults) {
  const YAML::Node scene = YAML::Load(templateText())["scene"];
  const SceneReading reading = readScene(scene);
  ASSERT_TRUE(reading.problems.empty()) << describe(reading.problems);
  Scene defaults;
  defaults.cloth.rows = reading.scene.cloth.rows;
  defaults.cloth.columns = reading.scene.cloth.columns;
  defaults.contact.self = true;  // what a user starts with; a scene file that does not say has none
  EXPECT_EQ(writeScene(reading.scene), writeScene(defaults));
}

// Entries of lists are examples; where they need no value of their own they show the default.
// What an entry of a list shows is the default of its key, unless the comment says that it has another, or none.
TEST(Template, EntriesAreReadableAndShowDefaults) {
  static const std::regex kHasNoOther("^  #   ( *)[a-z_]+: [^ ].* # (?!.*(required|default|one of)).*$");
  std::stringstream in(templateText());
  std::string rest;
  for (std::string line; std::getline(in, line);) {
    if (!std::regex_match(line, kHasNoOther)) rest += line + "\n";
  }
  EXPECT_LT(rest.size(), templateText().size());
  const auto sceneOf = [](const std::string& text) {
    YAML::Node scene = YAML::Load(withCommentedKeys(text))["scene"];
    // What cannot be given together is documented together.
    scene["drag"][0].remove("point");
    scene["drag"][0].remove("target");
    for (const char* key : {"size", "nodes"}) scene["hands"][0].remove(key);
    scene["hang"].remove("radius");
    scene["hang"].remove("fullness");
    scene["hang"].remove("overlap");
    scene["hang"].remove("start");
    for (const char* key : {"length", "size", "mesh", "scale"}) scene["obstacles"][0].remove(key);
    const SceneReading reading = readScene(scene);
    EXPECT_TRUE(reading.problems.empty()) << describe(reading.problems);
    return writeScene(reading.scene);
  };
  EXPECT_EQ(sceneOf(templateText()), sceneOf(rest));
}

// The node's own parameters stand above the scene; the node's tests compare them with what it reads.
TEST(Template, DocumentsTheNodeParameters) {
  const YAML::Node root = YAML::Load(templateText());
  std::set<std::string> keys;
  for (const auto& entry : root) keys.insert(entry.first.Scalar());
  const std::set<std::string> expected = {"world_frame",
                                          "obstacle_timeout",
                                          "state_rate",
                                          "state_rest_rate",
                                          "summary_from",
                                          "summary_frames",
                                          "watch_roscpp",
                                          "mesh_rate",
                                          "mesh_tolerance",
                                          "mesh_viewer_frame",
                                          "mesh_viewer_tolerance",
                                          "markers_rate",
                                          "max_catch_up",
                                          "state_folds",
                                          "handles",
                                          "handle_stiffness",
                                          "scene",
                                          "snapshot_file",
                                          "snapshot_period",
                                          "diagnostic_period",
                                          "grasp_timeout",
                                          "contact_points",
                                          "start_paused",
                                          "publish_clock",
                                          "points"};
  EXPECT_EQ(keys, expected);
}

}  // namespace
}  // namespace curtain
