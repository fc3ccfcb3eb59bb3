// SPDX-License-Identifier: BSD-3-Clause
//
// Runs curtain_batch, or another program, in a folder of its own and keeps what it said.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace curtain_test {

inline std::string readFile(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) result.push_back(line);
  return result;
}

struct Outcome {
  int exit_code = -1;
  std::string out, err;
};

/// Keys of a scene that swings, is blown in gusts and touches a ball.
constexpr const char* kMoving =
    "hang: {tilt: 0.7, to: [0.8, 0, 2.2]}\n"
    "wind: [{id: fan, position: [0.5, -1, 1.5], direction: [0, 1, 0], pressure: 3.0, unsteadiness: 2.0}]\n"
    "obstacles: [{name: ball, shape: sphere, radius: 0.3, position: [0.4, 0.4, 1.0]}]\n";

/// A folder that is removed with the test, and the program run in it.
class BatchTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::temp_directory_path() / ("curtain_batch_" + std::to_string(getpid()) + "_" + info->name());
    std::filesystem::create_directories(folder_);
    said_ = folder_.string() + ".said";
  }
  void TearDown() override {
    std::filesystem::remove_all(folder_);
    std::filesystem::remove(said_ + ".out");
    std::filesystem::remove(said_ + ".err");
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  std::string scene(const std::string& text, const std::string& name = "scene.yaml") const {
    std::ofstream(path(name)) << text;
    return path(name);
  }

  /// Small and quick: 5 x 4 nodes, two substeps a frame.
  std::string smallScene(const std::string& more = "") const {
    return scene("cloth: {rows: 5, columns: 4, folds: 3}\nsolver: {method: leapfrog, substeps: 8}\n" + more);
  }

  Outcome batch(const std::vector<std::string>& arguments) const { return run(CURTAIN_BATCH, arguments); }

  /// before: commands of the shell in front, ending in && or ;
  Outcome run(const std::string& program, const std::vector<std::string>& arguments,
              const std::string& before = "") const {
    std::string command = "cd '" + folder_.string() + "' && " + before + " timeout 300 '" + program + "'";
    for (const std::string& argument : arguments) command += " '" + argument + "'";
    command += " > '" + said_ + ".out' 2> '" + said_ + ".err' < /dev/null";
    const int status = std::system(command.c_str());
    Outcome outcome;
    outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    outcome.out = readFile(said_ + ".out");
    outcome.err = readFile(said_ + ".err");
    return outcome;
  }

  /// Its --stats.
  nlohmann::json stats(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--stats", path("stats.json")});
    const Outcome run = batch(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(readFile(path("stats.json")));
  }

  /// Names of the files in the folder.
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_)) {
      names.push_back(std::filesystem::relative(entry.path(), folder_).string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  std::filesystem::path folder_;
  std::string said_;  // beside the folder: what is written into that is the program's own
};

}  // namespace curtain_test
