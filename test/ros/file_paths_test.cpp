// SPDX-License-Identifier: BSD-3-Clause
//
// Paths that nothing can be written to are refused before anything is, in words that name them.
#include "ros/services/file_paths.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

namespace curtain_ros {
namespace {

TEST(FilePaths, ThatCanNotBeAreNamed) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / ("curtain_paths_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder / "inner");
  const std::string in = folder.string();
  EXPECT_EQ(problemOfOutput(in + "/state"), "");
  EXPECT_EQ(problemOfOutput(""), "path: is empty");
  EXPECT_EQ(problemOfOutput("state"), "path: 'state' must be a whole path, from / on");
  EXPECT_EQ(problemOfOutput("~/state"), "path: '~/state' must be a whole path, from / on");
  EXPECT_EQ(problemOfOutput(in + "/no/state"), "path: there is no folder '" + in + "/no'");
  EXPECT_EQ(problemOfOutput(in + "/inner"), "path: '" + in + "/inner' is a folder");
  EXPECT_EQ(problemOfOutput(in + "/inner/"), "path: '" + in + "/inner/' is a folder");
  EXPECT_NE(problemOfOutput(std::string("/tmp/a\0b", 8)).find("zero byte"), std::string::npos);
  EXPECT_LT(problemOfOutput(std::string(100000, 'x')).size(), 1000U);
  EXPECT_EQ(problemOfInput(""), "path: is empty");
  EXPECT_EQ(problemOfInput("state"), "path: 'state' must be a whole path, from / on");
  EXPECT_EQ(problemOfInput(in + "/no/state"), "") << "reading tells";
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace curtain_ros
