// SPDX-License-Identifier: BSD-3-Clause
#include "ros/services/file_paths.h"

#include <filesystem>
#include <system_error>

#include "ros/inputs/read_messages.h"

namespace curtain_ros {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestPath = 300;  // bytes of it in a message

// Callers do not know the node's working folder.
std::string problemOfAny(const std::string& path) {
  if (path.empty()) return "path: is empty";
  const std::string name = "path: '" + forLog(path, kLongestPath) + "' ";
  if (path.find('\0') != std::string::npos) return name + "has a zero byte";
  if (!fs::path(path).is_absolute()) return name + "must be a whole path, from / on";
  return "";
}

}  // namespace

std::string problemOfOutput(const std::string& path) {
  std::string problem = problemOfAny(path);
  if (!problem.empty()) return problem;
  std::error_code error;
  const fs::path folder = fs::path(path).parent_path();
  if (!fs::is_directory(folder, error))
    return "path: there is no folder '" + forLog(folder.string(), kLongestPath) + "'";
  if (fs::is_directory(path, error) || !fs::path(path).has_filename()) {
    return "path: '" + forLog(path, kLongestPath) + "' is a folder";
  }
  return "";
}

std::string problemOfInput(const std::string& path) { return problemOfAny(path); }

}  // namespace curtain_ros
