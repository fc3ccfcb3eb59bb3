// SPDX-License-Identifier: BSD-3-Clause
//
// The fuzzers' checks over what they started from and what they once found, without libFuzzer: every input that ever
// broke something stays in test/fuzz/corpus and is a test of every build.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "fuzz/checks.h"

namespace {

namespace fs = std::filesystem;

using curtain_test::Violation;

std::vector<fs::path> filesIn(const std::vector<std::string>& folders) {
  std::vector<fs::path> files;
  for (const std::string& folder : folders) {
    for (const auto& entry : fs::directory_iterator(fs::path(CURTAIN_SOURCE_DIR) / folder)) {
      if (entry.is_regular_file()) files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

void checkFiles(void (*check)(const std::string&), const std::vector<std::string>& folders) {
  const std::vector<fs::path> files = filesIn(folders);
  ASSERT_GT(files.size(), 5u) << "looked in the wrong place";
  for (const fs::path& path : files) {
    SCOPED_TRACE(path.string());
    std::ifstream file(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
    EXPECT_NO_THROW(check(bytes));
  }
}

TEST(FuzzCorpus, SceneTextsBreakNothing) {
  checkFiles(curtain_test::checkSceneText, {"test/fuzz/corpus/scene_yaml", "config/scenes", "test/scenes"});
}

TEST(FuzzCorpus, MeshesBreakNothing) { checkFiles(curtain_test::checkMesh, {"test/fuzz/corpus/mesh", "test/meshes"}); }

TEST(FuzzCorpus, SnapshotsBreakNothing) { checkFiles(curtain_test::checkSnapshot, {"test/fuzz/corpus/snapshot"}); }

TEST(FuzzCorpus, StepsBreakNothing) { checkFiles(curtain_test::checkSteps, {"test/fuzz/corpus/step"}); }

}  // namespace
