// SPDX-License-Identifier: BSD-3-Clause
//
// Made-up scenes through the parser and through curtain_batch: those that are valid run and stay finite; one wrong
// value anywhere is refused, by a message that names its key, and nothing is written. How many, and from which seed:
//   CURTAIN_RANDOM_SCENES=5000 CURTAIN_RANDOM_SEED=77 test_fuzz --gtest_filter=RandomScenes.*
#include <yaml-cpp/yaml.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "batch/batch_testing.h"
#include "curtain_sim/scene_yaml.h"
#include "drawn/scene_maker.h"
#include "fuzz/breakages.h"
#include "fuzz/scene_bits.h"
#include "known_keys.h"

namespace {

using curtain::Problem;
using curtain::Scene;
using curtain_test::Breakage;
using curtain_test::Outcome;
using curtain_test::Random;

std::uint64_t fromEnvironment(const char* name, std::uint64_t otherwise) {
  const char* const value = std::getenv(name);
  return value == nullptr ? otherwise : std::strtoull(value, nullptr, 10);
}

std::uint64_t sceneCount(std::uint64_t usual) { return fromEnvironment("CURTAIN_RANDOM_SCENES", usual); }

// The n-th valid scene; its meshes are a file that is there.
Scene validScene(std::uint64_t n) {
  Random choices(fromEnvironment("CURTAIN_RANDOM_SEED", 1) + 1000003 * n);
  for (;;) {
    std::optional<Scene> scene = curtain_test::makeScene(choices);
    if (!scene) continue;
    for (curtain::ObstacleParams& obstacle : scene->obstacles) {
      if (obstacle.shape == curtain::ShapeKind::kMesh)
        obstacle.mesh = CURTAIN_SOURCE_DIR "/test/meshes/cube_binary.stl";
    }
    return *scene;
  }
}

bool isUnder(const std::string& key, const std::string& above) {
  return key.compare(0, above.size(), above) == 0 &&
         (key.size() == above.size() || key[above.size()] == '.' || key[above.size()] == '[');
}

class RandomScenes : public curtain_test::BatchTest {};

// So few are made up in vain that the others come from all over the ranges.
TEST(RandomSceneMaker, MostScenesAreValid) {
  int valid = 0;
  constexpr int kTries = 500;
  Random choices(1);
  for (int i = 0; i < kTries; ++i) valid += curtain_test::makeScene(choices).has_value() ? 1 : 0;
  EXPECT_GT(valid, kTries / 2);
}

// "wind[0].radius" -> "wind[].radius".
std::string withoutIndex(const std::string& key) {
  std::string plain;
  bool inside = false;
  for (const char c : key) {
    inside = c == '[' || (inside && c != ']');
    if (!inside || c == '[') plain += c;
  }
  return plain;
}

// All values of all keys; of lists how many there are.
void note(const std::string& key, const YAML::Node& node, std::map<std::string, std::set<std::string>>& values) {
  values[key].insert(node.IsScalar() ? node.Scalar() : std::to_string(node.size()));
  for (const auto& entry : node) {
    if (node.IsMap()) note(curtain::joinKey(key, entry.first.Scalar()), entry.second, values);
    if (node.IsSequence()) note(key + "[]", entry, values);
  }
}

bool isLeftOut(const std::string& key) {
  // Of files, and of obstacles that there must be; of tf2; what is made to fit; what only a first cloth has, or few
  // layers.
  const std::set<std::string> others = {"hang.start.file",
                                        "hang.start.over",
                                        "rail.carriers.columns",
                                        "obstacles[].frame",
                                        "layers[].name",
                                        "layers[].cloth.closed",
                                        "layers[].hang.radius",
                                        "layers[].hang.overlap",
                                        "layers[].hang.start.file",
                                        "layers[].hang.start.over",
                                        "layers[].rail.carriers.columns"};
  const std::size_t bracket = key.find("[].");
  const bool of_list = bracket != std::string::npos && curtain_test::habitOf(key.substr(0, bracket)).chance == 0.0;
  return of_list || others.count(key) > 0 || curtain_test::habitOf(key).chance == 0.0;
}

// A key that habits.h does not know is drawn, too.
TEST(RandomSceneMaker, GivesEveryKeyByHabit) {
  std::vector<std::string> missing;
  for (const std::string& key : curtain::knownSceneKeys()) {
    if (!isLeftOut(key)) missing.push_back(key);
  }
  std::map<std::string, std::set<std::string>> values;
  Random random(1);
  // One of some 600 scenes has the rarest key, a value in a patch of a layer. So 6000 lack two values of it by
  // (1 + 10) exp(-10) = 5e-4, and most often fewer are made.
  for (int n = 0; n < 6000 && !missing.empty(); ++n) {
    const std::optional<Scene> scene = curtain_test::makeScene(random, curtain_test::Manner::kWild);
    if (!scene) continue;
    note("", YAML::Load(curtain::writeScene(*scene)), values);
    const auto varies = [&values](const std::string& key) {
      return values[key].size() > 1U || values[key + "[]"].size() > 1U;
    };
    missing.erase(std::remove_if(missing.begin(), missing.end(), varies), missing.end());
  }
  EXPECT_EQ(missing, std::vector<std::string>());
}

TEST(RandomSceneMaker, EveryKeyIsBroken) {
  std::vector<Breakage> all;
  for (std::uint64_t n = 0; n < 100; ++n) {
    for (Breakage& breakage : curtain_test::breakagesOf(validScene(n))) all.push_back(std::move(breakage));
  }
  for (const std::string& key : curtain::knownSceneKeys()) {
    // No layer is closed, few have strips, or patches that rub; the first cloth's keys are the same.
    if (key == "layers[].hang.radius" || key == "layers[].hang.overlap") continue;
    if (key == "layers[].cloth.patches[].bending_hysteresis") continue;
    const auto same = [&key](const Breakage& breakage) { return withoutIndex(breakage.key) == key; };
    EXPECT_TRUE(std::any_of(all.begin(), all.end(), same)) << key;
  }
}

TEST(RandomSceneMaker, WhatIsWrittenReadsBack) {
  for (std::uint64_t n = 0; n < sceneCount(300); ++n) {
    const Scene scene = validScene(n);
    const curtain::SceneReading back = curtain::readSceneText(curtain::writeScene(scene));
    ASSERT_TRUE(back.problems.empty()) << curtain::describe(back.problems) << "\n" << curtain::writeScene(scene);
    EXPECT_EQ(curtain_test::SceneBits::of(scene), curtain_test::SceneBits::of(back.scene))
        << curtain::writeScene(scene);
  }
}

// Items of a list are read alike: of a scene, the same value is tried in one of them only.
TEST(RandomSceneParser, NamesTheKeyOfWhatIsWrong) {
  for (std::uint64_t n = 0; n < sceneCount(2); ++n) {
    const Scene scene = validScene(n);
    const std::string text = curtain::writeScene(scene);
    std::set<std::string> tried;
    for (const Breakage& breakage : curtain_test::breakagesOf(scene)) {
      if (!tried.insert(withoutIndex(breakage.key) + ": " + breakage.value).second) continue;
      const std::string broken = curtain_test::breakText(text, breakage);
      const std::vector<Problem> problems = curtain::readSceneText(broken).problems;
      const bool named = std::any_of(problems.begin(), problems.end(),
                                     [&](const Problem& problem) { return isUnder(problem.key, breakage.key); });
      EXPECT_TRUE(named) << breakage.key << ": " << breakage.value << "\n"
                         << curtain::describe(problems) << "\nin\n"
                         << broken;
    }
  }
}

TEST_F(RandomScenes, ValidOnesRun) {
  for (std::uint64_t n = 0; n < sceneCount(60); ++n) {
    Scene scene = validScene(n);
    const std::string text = curtain::writeScene(scene);
    SCOPED_TRACE(text);
    const std::string frames = std::to_string(3.0 / scene.solver.frame_rate);
    const Outcome run = batch({this->scene(text), "--duration", frames, "--stats", "stats.json"});
    const bool mesh_refused =
        run.exit_code == 2 && run.err.find("mesh '") != std::string::npos;  // scaled beyond all use
    if (mesh_refused) continue;
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(nlohmann::json::parse(curtain_test::readFile(path("stats.json")))["finite"].get<bool>());
  }
}

TEST_F(RandomScenes, BrokenOnesAreRefused) {
  const std::uint64_t count = sceneCount(200);
  for (std::uint64_t n = 0; n < count; ++n) {
    const Scene scene = validScene(n);
    const std::vector<Breakage> all = curtain_test::breakagesOf(scene);
    const Breakage& breakage = all[Random(n).below(all.size())];
    const std::string broken = curtain_test::breakText(curtain::writeScene(scene), breakage);
    SCOPED_TRACE(breakage.key + ": " + breakage.value + "\nin\n" + broken);
    const Outcome run = batch({this->scene(broken), "--out", "out.csv", "--mesh", "mesh.ply", "--stats", "stats.json"});
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_NE(run.err.find(breakage.key), std::string::npos) << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(files(), std::vector<std::string>{"scene.yaml"}) << "nothing written";
  }
}

}  // namespace
